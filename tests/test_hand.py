"""Edits by hand: pure, refused with one line where they cannot be made, read from logs."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.edit_log.json_lines import as_json_lines, from_json_lines, write_log
from pipeline.edit_log.read import read_log
from pipeline.options.edit_log import EditLog
from stages.hand import EDITS, Edit
from stages.hand.collapse_vertex import CollapseVertex
from stages.hand.flip_edge import FlipEdge
from stages.hand.insert import Insert
from stages.hand.lock import Lock
from stages.hand.move_vertex import MoveVertex
from stages.hand.regions.set_focus import SetFocus
from stages.hand.regions.style_region import StyleRegion
from stages.hand.regions.texture_region import TextureRegion
from stages.hand.remove import Remove
from stages.hand.retriangulate import Retriangulate
from stages.hand.split_edge import SplitEdge
from stages.hand.split_triangle import SplitTriangle
from stages.hand.turn_base_edge import TurnBaseEdge
from stages.hand.unlock import Unlock
from stages.hand.worked import Worked
from stages.validate import assert_valid
from tests.meshes import HEIGHT, WIDTH, random_mesh, two_triangles
from warp_kernels.errors import EditError, MediaError

POINTS = st.tuples(st.floats(-3, WIDTH + 3), st.floats(-3, HEIGHT + 3))
POLYGONS = st.lists(POINTS, min_size=2, max_size=5).map(tuple)
BRUSHES: dict[str, Any] = {
    "frame": st.just(0),
    "at": POINTS,
    "radius": st.floats(0, 30),
    "count": st.integers(0, 12),
    "spread": st.sampled_from(["uniform", "normal"]),
    "seed": st.integers(0, 9),
}
REGIONS: tuple[dict[str, Any], ...] = (
    {"frame": st.just(0), "at": POINTS, "radius": st.floats(0, 30)},
    {"frame": st.just(0), "polygon": POLYGONS},
)
WHAT = {"frame": st.just(0), "what": st.sampled_from(["vertices", "edges"])}
SINGLE = st.one_of(
    *(st.builds(kind, st.just(0), POINTS) for kind in (SplitEdge, SplitTriangle, FlipEdge)),
    *(st.builds(kind, st.just(0), POINTS) for kind in (CollapseVertex, TurnBaseEdge)),
    st.builds(MoveVertex, st.just(0), POINTS, POINTS, st.booleans()),
    st.builds(Insert, **BRUSHES),
    st.builds(Remove, **BRUSHES),
    st.builds(Retriangulate, st.just(0), POLYGONS, st.integers(0, 12)),
    *(st.builds(kind, polygon=POLYGONS, **WHAT) for kind in (Lock, Unlock)),
    *(st.builds(kind, at=POINTS, **WHAT) for kind in (Lock, Unlock)),
    *(st.builds(SetFocus, strength=st.floats(0, 5), **region) for region in REGIONS),
    *(st.builds(StyleRegion, style=st.just("flat"), **region) for region in REGIONS),
    *(st.builds(TextureRegion, file=st.just("cushion"), **region) for region in REGIONS),
)


def same(one: Worked, other: Worked) -> bool:
    """Whether two meshes and what is held of them are equal to the bit."""
    names = ("vertices", "triangles", "vertex_ids", "triangle_ids")
    pairs = [(getattr(one.mesh, n), getattr(other.mesh, n)) for n in names]
    pairs += [(getattr(one.locks, n), getattr(other.locks, n)) for n in ("vertices", "edges")]
    pairs += [(one.locks.bare, other.locks.bare)]
    return one.focus == other.focus and all(np.array_equal(a, b) for a, b in pairs)


@settings(max_examples=25)
@given(st.integers(0, 50), st.lists(SINGLE, max_size=25))
def test_a_log_leaves_meshes_valid_and_comes_back_to_the_bit(seed: int, edits: list[Edit]) -> None:
    begun = Worked(random_mesh(seed, inner=25))
    states, made = [begun], []
    for edit in edits:
        result = EditLog((edit,)).replay(0, states[-1])
        after = result.worked
        if result.refused:
            assert after is states[-1]
            assert "\n" not in result.refused[0]
            assert re.search(";|choose|must|give", result.refused[0])
            continue
        assert_valid(after.mesh)
        assert (np.diff(after.mesh.vertex_ids) > 0).all()
        assert same(after, after.became(after.mesh))  # no lock names what is gone
        states.append(after)
        made.append(edit)
    log = from_json_lines(as_json_lines(EditLog(tuple(made))), "log")
    assert log.edits == tuple(made)
    for count in (0, len(made) // 2, len(made)):  # undo of all, of some, of none
        replayed = EditLog(log.edits[:count]).replay(0, Worked(random_mesh(seed, inner=25)))
        assert not replayed.refused
        assert same(replayed.worked, states[count])


def test_every_kind_is_in_the_registry_and_begins_with_its_frame() -> None:
    assert len(EDITS) == 14
    for name in EDITS:
        assert next(iter(EDITS[name].__dataclass_fields__)) == "frame"  # type: ignore[attr-defined]


def test_what_is_made_is_held() -> None:
    mesh = random_mesh(3)
    split = SplitEdge(0, (40, 30)).apply(Worked(mesh))
    assert split.locks.vertices.tolist() == [mesh.next_vertex_id]
    moved = MoveVertex(0, (40, 30), (40.5, 30.5)).apply(split)
    place = moved.mesh.vertices[np.isin(moved.mesh.vertex_ids, moved.locks.vertices)]
    assert [40.5, 30.5] in place.tolist()
    brushed = Insert(0, (50, 30), 20, 12).apply(Worked(mesh))
    assert len(brushed.locks.vertices) == 12
    fresh = brushed.mesh.vertices[-12:]
    assert (np.linalg.norm(fresh - (50, 30), axis=1) <= 20).all()


def test_a_flipped_edge_is_held_and_flips_back() -> None:
    begun = Worked(two_triangles())
    flipped = FlipEdge(0, (2, 2)).apply(begun)
    assert flipped.locks.edges.tolist() == [[0, 2]]
    held = flipped.locks.held(flipped.mesh)
    assert held.edges.sum() == 2
    assert held.kept.all()
    back = FlipEdge(0, (2, 2)).apply(flipped)
    assert back.locks.edges.tolist() == [[1, 3]]


def test_a_vertex_goes_into_its_nearest_neighbour_and_none_comes_back() -> None:
    mesh = random_mesh(5)
    vertex = 30
    at = (float(mesh.vertices[vertex][0]), float(mesh.vertices[vertex][1]))
    gone = CollapseVertex(0, at).apply(Worked(mesh))
    assert mesh.vertex_ids[vertex] not in gone.mesh.vertex_ids
    around = mesh.triangle_ids[(mesh.triangles == vertex).any(axis=1)]
    assert set(gone.locks.bare) == set(around) & set(gone.mesh.triangle_ids)
    assert gone.locks.held(gone.mesh).undivided.any()
    # whoever puts a vertex there by hand may
    again = SplitTriangle(0, at).apply(gone) if at not in gone.mesh.vertices.tolist() else gone
    assert len(again.locks.bare) < len(gone.locks.bare)


def test_a_region_is_triangulated_anew_and_the_rest_stays() -> None:
    mesh = random_mesh(7, inner=120)
    polygon = ((20.0, 10.0), (70.0, 10.0), (70.0, 50.0), (20.0, 50.0))
    anew = Retriangulate(0, polygon, count=40).apply(Worked(mesh)).mesh
    x, y = anew.vertices.T
    inside = (x > 20) & (x < 70) & (y > 10) & (y < 50)
    assert inside.sum() == 40
    outside = ~np.isin(mesh.vertex_ids, anew.vertex_ids)
    assert ((mesh.vertices[outside] > (20, 10)) & (mesh.vertices[outside] < (70, 50))).all()


def test_a_brush_that_asks_for_too_much_ends() -> None:
    """So many as fit, and not a try for each that does not."""
    filled = Insert(0, (48, 32), 9, 10_000).apply(Worked(random_mesh(1, inner=4)))
    assert 30 < len(filled.locks.vertices) < 1000
    assert_valid(filled.mesh)


def test_the_middle_of_a_normal_brush_gets_most() -> None:
    mesh = random_mesh(1, inner=4)
    spread = []
    for name in ("uniform", "normal"):
        made = Insert(0, (48, 32), 25, 60, name, seed=2).apply(Worked(mesh)).mesh
        spread.append(np.linalg.norm(made.vertices[-60:] - (48, 32), axis=1).mean())
    assert spread[1] < 0.85 * spread[0]


REFUSED: list[tuple[Edit, str]] = [
    (SplitEdge(0, (200, 3)), "outside of the picture"),
    (SplitEdge(0, (0, 0)), "is there already"),
    (SplitTriangle(0, (2, 2)), "lies on an edge"),
    (CollapseVertex(0, (0.2, 0.1)), "corner of the picture"),
    (FlipEdge(0, (2, 0)), "lies on the border"),
    (MoveVertex(0, (0, 0), (1, 1)), "corner of the picture"),
    (Insert(0, (2, 2), 0), "radius 0"),
    (Insert(0, (2, 2), 1, 10**9), "count 1000000000"),
    (Insert(0, (2, 2), 1, spread="even"), "spread 'even'"),
    (Insert(0, (2, 2), 0.1), "not one vertex fits"),
    (Remove(0, (2, 2), 1), "no vertex within"),
    (Retriangulate(0, ((1, 1), (2, 2))), "no inside"),
    (Retriangulate(0, ((9, 9), (12, 9), (9, 12))), "outside of the picture"),
    (Retriangulate(0, ((0, 0), (1e300, 0), (0, 1e300))), "further than 1e\\+06 px"),
    (SetFocus(frame=0, at=(2, 2)), "radius 0"),
    (Lock(0), "give either"),
    (Lock(0, at=(2, 2), what="faces"), "what 'faces'"),
    (Lock(0, polygon=((1, 1), (1.1, 1), (1, 1.1))), "holds no vertices"),
]


@pytest.mark.parametrize(("edit", "told"), REFUSED)
def test_what_cannot_be_made_is_told_and_left_out(edit: Edit, told: str) -> None:
    begun = Worked(two_triangles())
    with pytest.raises(EditError, match=told):
        edit.apply(begun)
    replayed = EditLog((edit,)).replay(0, begun)
    assert replayed.worked is begun
    assert len(replayed.refused) == 1
    assert replayed.refused[0].startswith("edit 1 (")


LINES = [
    ("nonsense", "line 2: is not JSON"),
    ("[1, 2]", "line 2: [1, 2] is not an edit; write one edit a line"),
    ('{"frame": 3}', 'line 2: it has no "edit"'),
    ('{"edit": "flip"}', "line 2: no edit is called 'flip'"),
    ('{"edit": "flip_edge", "frame": 3}', "line 2: flip_edge has no at; it needs frame, at"),
    ('{"edit": "flip_edge", "frame": 3, "at": [1]}', "line 2: flip_edge: at: [1] is not such"),
    ('{"edit": "flip_edge", "frame": 3, "at": [1, NaN]}', "line 2: flip_edge: at: nan is no"),
    ('{"edit": "flip_edge", "frame": -3, "at": [1, 1]}', "line 2: frame -3 is none"),
    ('{"edit": "flip_edge", "frame": 3, "at": [1, 1], "by": 2}', "has no 'by'; it has frame, at"),
    ('{"edit": "flip_edge", "frame": true, "at": [1, 1]}', "frame: True instead of a whole number"),
    ('{"edit": "lock", "class": "Lock", "frame": 1}', "lock has no 'class'"),
]


@pytest.mark.parametrize(("line", "told"), LINES)
def test_a_log_that_cannot_be_read_names_line_and_remedy(line: str, told: str) -> None:
    with pytest.raises(MediaError) as failure:
        from_json_lines(f"# my edits\n{line}\n", "log.jsonl")
    assert str(failure.value).startswith("log.jsonl: line 2: ")
    assert told in str(failure.value)


def test_logs_are_files(tmp_path: Path) -> None:
    log = EditLog((FlipEdge(4, (1.5, 2.0)), Lock(2, polygon=((0, 0), (9, 0), (0, 9)))))
    write_log(log, tmp_path / "log.jsonl")
    assert read_log(tmp_path / "log.jsonl") == log
    first = (tmp_path / "log.jsonl").read_text(encoding="utf-8").splitlines()[0]
    assert json.loads(first) == {"edit": "flip_edge", "frame": 4, "at": [1.5, 2.0]}
    assert log.frames == (2, 4)
    assert [log.next_frame(index) for index in (0, 3, 5)] == [2, 4, None]
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    for name, told in (("other.jsonl", "check the name"), ("picture.png", "give a file of edits")):
        with pytest.raises(MediaError, match=rf"cannot be read \([^']*\); {told}"):
            read_log(tmp_path / name)


def test_budgets_count_what_is_free() -> None:
    worked = Insert(0, (50, 30), 20, 12).apply(Worked(random_mesh(3)))
    assert worked.locks.extra(worked.mesh) == 24
    border = Lock(0, at=(0, 0)).apply(
        replace(worked, locks=worked.locks.without(worked.locks.vertices))
    )
    assert border.locks.extra(border.mesh) == 0
