"""Painted focus: more triangles where it was painted, through the shot and whoever solves it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from pipeline.edit_log.json_lines import as_json_lines, from_json_lines
from pipeline.options.edit_log import EditLog
from pipeline.track import TrackReader
from stages.frame import Frame
from stages.hand.insert import Insert
from stages.hand.regions.set_focus import SetFocus
from stages.hand.worked import Worked
from stages.masks.area import Area, Stroke
from stages.masks.painted import painted, within_sides
from stages.motion.painted_focus import NOTHING_PAINTED
from stages.snapshot import Snapshot
from stages.topology.refine_options import RefineOptions
from stages.validate import assert_valid
from tests.meshes import random_mesh
from tests.test_edited import Interrupting
from tests.tracks import CUT, QUICK, rows_of, solve_to, write_clip
from warp_kernels.errors import EditError

AREA = Area((66.0, 32.0), 20.0)
FOCUS = SetFocus(frame=2, at=AREA.at, radius=AREA.radius, strength=3.0)
OTHER = SetFocus(frame=4, at=(20.0, 50.0), radius=9.0)
LOG = EditLog((FOCUS, Insert(4, (30.0, 32.0), 12.0, 5), OTHER))
MANY = replace(QUICK, frame_iterations=12, refine=RefineOptions(triangles=160))


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The clip."""
    return write_clip(tmp_path_factory.mktemp("focus") / "in.mp4")


@pytest.fixture(scope="module")
def whole(clip: Path) -> Path:
    """Its track, with focus painted in two frames of the first shot."""
    track = clip.with_name("whole.mtrk")
    assert not solve_to(track, clip, edits=LOG).warnings
    return track


def inside(snapshot: Snapshot) -> int:
    """Triangles whose centres lie where focus was painted."""
    centres = snapshot.mesh.corners.mean(axis=1)
    return int((np.linalg.norm(centres - AREA.at, axis=1) < AREA.radius).sum())


def test_there_are_more_triangles_through_the_shot(clip: Path, tmp_path: Path) -> None:
    counts = []
    for edits in (EditLog(), EditLog((FOCUS,))):
        solved = tmp_path / f"{len(edits.edits)}.mtrk"
        solve_to(solved, clip, f"0-{CUT}", edits=edits, triangulate=MANY)
        with TrackReader(solved) as track:
            counts.append([inside(track.snapshot(frame)) for frame in range(CUT + 1)])
            for frame in range(CUT):
                assert_valid(track.snapshot(frame).mesh)
                assert track.snapshot(frame).mesh.triangle_count <= 162
    plain, painted_ = counts
    assert all(np.array(painted_[:CUT]) > 1.2 * np.array(plain[:CUT]))
    assert painted_[CUT] == plain[CUT]  # the next shot knows nothing of it


@pytest.mark.parametrize("after", [3, 5, CUT + 1])
def test_an_interrupted_job_goes_on(clip: Path, whole: Path, tmp_path: Path, after: int) -> None:
    track = tmp_path / "track.mtrk"
    with pytest.raises(KeyboardInterrupt):
        solve_to(track, clip, edits=LOG, progress=Interrupting(after))
    solve_to(track, clip, edits=LOG, resume=True)
    assert rows_of(track) == rows_of(whole)


def test_a_frame_is_weighed_where_its_triangles_were_painted() -> None:
    """Of strokes the strongest counts; triangles of which most lies there take it along."""
    mesh = random_mesh(4, inner=150)
    size = mesh.width, mesh.height
    strokes = FOCUS.apply(Worked(mesh)).focus
    assert strokes == (Stroke(AREA, 3.0),)
    pixels = np.zeros((mesh.height, mesh.width, 3), dtype=np.uint8)
    frame = Frame(0, 0, Fraction(1, 25), pixels)
    assert NOTHING_PAINTED.weighed(frame, mesh) is frame
    inside = painted([AREA], size) > 0
    both = (*strokes, Stroke(AREA, 1.0))
    weights = NOTHING_PAINTED.weighed(frame, mesh, both).weights
    assert weights is not None
    assert set(weights[inside]) == {8 * 13}
    assert set(weights[~inside]) == {8}
    strong = replace(frame, weights=np.full((mesh.height, mesh.width), 200, dtype=np.uint8))
    weights = NOTHING_PAINTED.weighed(strong, mesh, strokes).weights
    assert weights is not None
    assert (weights[inside].min(), weights[~inside].max()) == (255, round(255 / 13))


def test_triangles_become_pixels_without_gaps() -> None:
    """All sides of some triangles hold what each of them holds by itself."""
    mesh = random_mesh(2, inner=60)
    some = [1, 4, 7, *range(0, mesh.triangle_count, 3)]
    size = mesh.width, mesh.height
    corners = mesh.corners[some]
    ends = np.roll(corners, -1, axis=1)
    together = within_sides(corners.reshape(-1, 2), ends.reshape(-1, 2), size)
    alone = [painted([Area(polygon=tuple(map(tuple, c.tolist())))], size) > 0 for c in corners]
    assert (np.sum(alone, axis=0) <= 1).all()
    assert np.array_equal(together, np.any(alone, axis=0))


def test_it_is_a_line_and_refuses_what_there_is_not() -> None:
    assert from_json_lines(as_json_lines(LOG), "log") == LOG
    for strength in (0.0, -1.0, 4.5):
        with pytest.raises(EditError, match="strength"):
            replace(OTHER, strength=strength).apply(Worked(random_mesh(1)))
