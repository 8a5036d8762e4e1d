"""What the editor works on: edits, undo, ghosts, colours, and the same without a browser."""

import json
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.cli import main
from pipeline.commands.grammar import build_parser
from pipeline.editor.bench.command_lines import solve_line
from pipeline.editor.bench.easel import look_of
from pipeline.editor.bench.replays import DENSE, Replays
from pipeline.editor.bench.session import Session
from pipeline.editor.wire.packed import packed_mesh, packed_pixels
from pipeline.options.build import build_job
from pipeline.options.edit_log import EditLog
from pipeline.options.solve_options import SolveOptions
from pipeline.track import TrackReader
from pipeline.track.plain_values import to_plain
from stages.hand import Edit
from stages.hand.collapse_vertex import CollapseVertex
from stages.hand.flip_edge import FlipEdge
from stages.hand.insert import Insert
from stages.hand.move_vertex import MoveVertex
from stages.hand.regions.set_focus import SetFocus
from stages.hand.split_edge import SplitEdge
from stages.hand.split_triangle import SplitTriangle
from stages.hand.worked import Worked
from stages.masks.area import Stroke
from stages.mesh import Mesh
from stages.validate import assert_valid
from tests.editing import opened, write_job
from tests.tracks import rows_of
from warp_kernels.errors import EditError, OptionError

PLACES = st.tuples(st.floats(0.5, 95.5), st.floats(0.5, 63.5))
EDITS = st.one_of(
    st.builds(SplitTriangle, st.just(0), PLACES),
    st.builds(SplitEdge, st.just(0), PLACES),
    st.builds(CollapseVertex, st.just(0), PLACES),
    st.builds(FlipEdge, st.just(0), PLACES),
    st.builds(MoveVertex, st.just(0), PLACES, PLACES),
    st.builds(Insert, st.just(0), PLACES, st.just(12.0), st.just(3)),
)


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A still's track."""
    return write_job(tmp_path_factory.mktemp("job"))


@pytest.fixture
def session(solved: Path, tmp_path: Path) -> Iterator[Session]:
    """A session on a copy of it."""
    found = opened(Path(shutil.copy(solved, tmp_path / "job.mtrk")))
    yield found
    found.close()


def same(one: Mesh, other: Mesh) -> bool:
    """Whether two meshes are equal to the bit."""
    names = ("vertices", "triangles", "vertex_ids", "triangle_ids")
    return all(np.array_equal(getattr(one, n), getattr(other, n)) for n in names)


def test_edits_are_shown_undone_and_done_again(session: Session) -> None:
    first = session.shown(0)
    number = session.make([SplitTriangle(0, (40.0, 30.0))], after=0)
    edited = session.shown(0)
    assert edited.mesh.triangle_count == first.mesh.triangle_count + 2
    assert len(edited.locks.vertices) == 1
    assert session.state() == {
        "number": number,
        "edits": 1,
        "edited": [0],
        "pending": [0],
        "hasGround": True,
        "canUndo": True,
        "canRedo": False,
    }
    session.undo()
    assert same(session.shown(0).mesh, first.mesh)
    assert np.array_equal(session.shown(0).coefficients, first.coefficients)
    session.redo()
    assert same(session.shown(0).mesh, edited.mesh)


def test_what_cannot_be_made_leaves_no_trace(session: Session) -> None:
    """All edits of one gesture are made, or none."""
    with pytest.raises(EditError, match="corner of the picture"):
        session.make([SplitTriangle(0, (40.0, 30.0)), CollapseVertex(0, (0.0, 0.0))], after=0)
    assert session.state()["edits"] == 0


def test_a_ghost_is_what_comes(session: Session) -> None:
    """Vertices are where the preview showed them, and the preview changes nothing."""
    brush = Insert(0, (40.0, 30.0), 15.0, 4, seed=3)
    before = session.shown(0).mesh
    ghost = session.ghost(brush)
    assert len(ghost.fresh) > 0
    assert session.state()["edits"] == 0
    session.make([brush], after=0)
    after = session.shown(0).mesh
    assert np.array_equal(
        after.vertices[~np.isin(after.vertex_ids, before.vertex_ids)], ghost.fresh
    )


@settings(max_examples=6)
@given(edits=st.lists(EDITS, min_size=1, max_size=40), cut=st.integers(0, 40))
def test_replays_are_those_of_the_log(solved: Path, edits: list[Edit], cut: int) -> None:
    """Whatever was kept of earlier states: after undo and another branch as well."""
    with TrackReader(solved) as reader:
        ground = Worked(reader.snapshot(0).mesh)
    replays = Replays(ground)
    for log in (edits[:cut], edits, edits[: cut // 2], edits[cut // 2 :] + edits):
        found = replays.after(log).mesh
        assert_valid(found)
        assert same(found, EditLog(tuple(log)).replay(0, ground).worked.mesh)
    assert replays.after([]) is ground


def test_undo_far_back_makes_states_again_that_were_let_go(solved: Path) -> None:
    with TrackReader(solved) as reader:
        ground = Worked(reader.snapshot(0).mesh)
    rng = np.random.default_rng(1)
    edits = [SplitTriangle(0, tuple(rng.uniform(1, 60, 2))) for _ in range(2 * DENSE)]
    replays = Replays(ground)
    replays.after(edits)
    for count in (2 * DENSE - 1, DENSE, 7, 1):
        expected = EditLog(tuple(edits[:count])).replay(0, ground).worked.mesh
        assert same(replays.after(edits[:count]).mesh, expected)


def test_edits_with_which_the_track_was_solved_can_be_undone(solved: Path, tmp_path: Path) -> None:
    """The still's mesh before them is found again, to the bit."""
    log = tmp_path / "log.jsonl"
    log.write_text('{"edit": "split_triangle", "frame": 0, "at": [40, 30]}\n')
    source, track = str(solved.parent / "still.png"), tmp_path / "edited.mtrk"
    flags = ["--iterations", "8", "--frame-iterations", "4", "--triangles", "40"]
    assert main(["solve", source, *flags, "--edits", str(log), "-o", str(track)]) == 0
    session = opened(track)
    with TrackReader(solved) as plain, TrackReader(track) as edited:
        assert same(session.shown(0).mesh, edited.snapshot(0).mesh)
        session.undo()
        assert same(session.shown(0).mesh, plain.snapshot(0).mesh)
    session.close()


def test_the_command_line_makes_the_same(session: Session, tmp_path: Path) -> None:
    """What the page says to type gives the mesh that the optimiser gives here, to the bit."""
    edits = [Insert(0, (40.0, 30.0), 15.0, 4), MoveVertex(0, (48.0, 30.0), (49.0, 31.0))]
    session.make(edits, after=0)
    session.make([FlipEdge(0, (70.0, 40.0))], after=2)
    line = solve_line(session.path, session.options)
    words = shlex.split(line)
    assert words[:2] == ["trimotion", "solve"]
    assert main(words[1:]) == 0
    picture, model = session.picture(0), session.easel.model
    here = session.easel.solved(picture, session.worked(0), model)
    with TrackReader(Path(words[words.index("-o") + 1])) as track:
        there = track.snapshot(0)
    assert same(here.mesh, there.mesh)
    assert np.array_equal(here.coefficients, there.coefficients)
    assert np.array_equal(here.locks.vertices, there.locks.vertices)


@pytest.mark.parametrize(
    "flags",
    [
        [],
        ["--triangles", "33", "--trust-region", "0.3", "--seed", "4"],
        ["--layout", "grid", "--focus", "none", "--color", "linear", "--independent"],
        ["--focus", "center", "--frames", "3-9x2", "--cuts", "none"],
        ["--layout", "poisson", "--flow", "none", "--start", "1.5"],
    ],
    ids=str,
)
def test_flags_are_found_again(flags: list[str], tmp_path: Path) -> None:
    """The line that is shown gives the options that were given."""

    def options(words: list[str]) -> SolveOptions:
        return build_job(
            {k: v for k, v in vars(build_parser().parse_args(words)).items() if k != "preset"}
            | {"source": "clip.mp4", "output": None, "track": "job.mtrk"}
        ).solve

    asked = options(["solve", "clip.mp4", "-o", "x.mtrk", *flags])
    line = shlex.split(solve_line(tmp_path / "job.mtrk", asked))
    at = line.index("--edits")
    again = options([*line[1:at], *line[at + 2 :]])
    assert to_plain(again) == to_plain(asked)


def test_looks_are_drawn_as_the_output_is(session: Session, tmp_path: Path) -> None:
    """A look that needs other colours than the track's, too."""
    session.make([SplitTriangle(0, (40.0, 30.0))], after=0)
    plain = session.drawn(0, look_of([]))
    assert plain.shape == (64, 96, 3)
    smooth = session.drawn(0, look_of(["gradient", "edges:width=2"]))
    assert not np.array_equal(plain, smooth)
    assert np.array_equal(session.drawn(0, look_of([])), plain)


def test_a_packed_mesh_can_be_read(session: Session) -> None:
    """By the rule that the page follows."""
    snapshot = session.shown(0)
    packed = packed_mesh({"frame": 0}, snapshot)
    length = int.from_bytes(packed[:4], "little")
    head = json.loads(packed[4 : 4 + length])
    place = 4 + length
    kinds = {"f8": "<f8", "f4": "<f4", "u4": "<u4", "u1": "u1"}
    found = {}
    for name, kind, size in head["arrays"]:
        assert place % 8 == 0
        found[name] = np.frombuffer(packed, kinds[kind], size, place)
        place += -(-found[name].nbytes // 8) * 8
    assert place == len(packed)
    assert np.array_equal(found["vertices"].reshape(-1, 2), snapshot.mesh.vertices)
    assert np.array_equal(found["triangles"].reshape(-1, 3), snapshot.mesh.triangles)


def test_pictures_are_no_larger_than_browsers_take() -> None:
    """And a long one keeps its shape."""
    packed = packed_pixels({"kind": "picture"}, np.full((20_000, 50, 3), 9, dtype=np.uint8))
    head = json.loads(packed[4 : 4 + int.from_bytes(packed[:4], "little")])
    assert (head["rows"], head["columns"], head["channels"]) == (6667, 17, 3)


def test_looking_leaves_the_track_as_it_was(solved: Path, session: Session) -> None:
    before = rows_of(solved)
    session.shown(0)
    session.drawn(0, look_of([]))
    session.make([SplitTriangle(0, (40.0, 30.0))], after=0)
    assert rows_of(session.path) == before


def test_the_optimiser_works_step_by_step(session: Session) -> None:
    """The error falls, what is held stays, meshes are valid, and nothing is kept of it."""
    session.make([Insert(0, (40.0, 30.0), 15.0, 5)], after=0)
    before = session.worked(0)
    errors = []
    for _ in range(24):
        live = session.optimise(0, {"triangles": 40})
        assert_valid(live.worked.mesh)
        errors.append(live.rmse)
    assert errors[-1] < 0.95 * errors[0]
    now = live.worked.mesh
    ids = before.locks.vertices
    assert len(ids) > 0
    held = now.vertices[np.isin(now.vertex_ids, ids)]
    put = before.mesh.vertices[np.isin(before.mesh.vertex_ids, ids)]
    assert np.abs(held - put).max() < 1e-3
    assert session.worked(0) is before
    assert session.state()["edits"] == 1


def test_the_optimiser_goes_where_it_is_led(session: Session) -> None:
    """More triangles, fewer, and a threshold that none exceeds."""
    for wanted in (70, 30):
        for _ in range(90):
            live = session.optimise(0, {"triangles": wanted})
        assert abs(live.worked.mesh.triangle_count - wanted) <= 2
    for _ in range(30):
        live = session.optimise(0, {"triangles": 90, "error": 200.0})
    assert live.worked.mesh.triangle_count <= 34
    with pytest.raises(OptionError, match="--trust-region"):
        session.optimise(0, {"trust_region": -1.0})
    session.undo()
    assert session.live is None


def test_the_optimiser_sees_what_is_painted(session: Session) -> None:
    """Triangles gather where focus is painted, while it works or before; what is told does not."""

    def gathered() -> int:
        live = session.optimise(0, {"triangles": 40})
        for _ in range(60):
            live = session.optimise(0, {"triangles": 40})
        shown = session.easel.fitted(live.frame, live.worked, session.film.model)
        assert live.rmse == pytest.approx(shown.rmse)
        away = live.worked.mesh.corners.mean(axis=1) - (70.0, 45.0)
        return int((np.hypot(*away.T) < 18).sum())

    plain = gathered()
    focus = SetFocus(frame=0, at=(70.0, 45.0), radius=18.0, strength=4.0)
    session.make([focus], after=0, in_live=True)
    assert gathered() > 1.5 * plain
    assert session.focus(0) == (Stroke(focus.area, 4.0),)
    session.live = None
    assert gathered() > 1.5 * plain
    session.undo()
    assert gathered() == plain
    assert session.focus(0) == ()


def test_the_optimiser_goes_on_with_edits(session: Session) -> None:
    """Edits are made in the mesh that is optimised and in the frame, or in neither."""
    for _ in range(8):
        session.optimise(0, {"triangles": 40})
    brush = Insert(0, (40.0, 30.0), 15.0, 4, seed=3)
    ghost = session.ghost(brush, in_live=True)
    number = session.make([brush], after=0, in_live=True)
    live = session.live
    assert live is not None
    fresh = live.worked.locks.vertices
    at = live.worked.mesh.vertices[np.isin(live.worked.mesh.vertex_ids, fresh)]
    assert np.array_equal(at, ghost.fresh)
    session.optimise(0, {"triangles": 40})
    assert session.live is live
    assert live.steps == 9
    assert_valid(live.worked.mesh)
    assert np.array_equal(live.worked.locks.vertices, fresh)
    before = live.worked
    with pytest.raises(EditError, match="corner of the picture"):
        session.make([CollapseVertex(0, (0.0, 0.0))], after=number, in_live=True)
    assert live.worked is before
    assert len(session.shown(0).locks.vertices) == len(fresh)
    session.undo()
    assert session.optimise(0, {"triangles": 40}).steps == 1
