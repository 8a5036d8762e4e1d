"""Edits by hand reach through their shot, and a replay of their log gives the same bits."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pipeline.edit_log.json_lines import as_json_lines, from_json_lines, write_log
from pipeline.edit_log.read import read_log
from pipeline.options.edit_log import EditLog
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.hand import Edit
from stages.hand.collapse_vertex import CollapseVertex
from stages.hand.flip_edge import FlipEdge
from stages.hand.insert import Insert
from stages.hand.lock import Lock
from stages.hand.move_vertex import MoveVertex
from stages.hand.remove import Remove
from stages.validate import assert_valid
from tests.jobs import job_of
from tests.random_edits import random_edit
from tests.tracks import COUNT, CUT, QUICK, rows_of, solve_to, write_clip
from warp_kernels.errors import OptionError

AT = 3
"""The frame that is edited: in the middle of the first shot."""
LOG = EditLog(
    (
        Insert(AT, (48.0, 32.0), 16.0, 8),
        MoveVertex(AT, (70.0, 21.0), (71.0, 22.0)),
        FlipEdge(AT, (28.5, 47.1)),
        Lock(CUT + 2, at=(40.0, 30.0)),
        Lock(CUT + 2, polygon=((200.0, 0.0), (210.0, 0.0), (200.0, 9.0))),
    )
)


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The clip."""
    return write_clip(tmp_path_factory.mktemp("edited") / "in.mp4")


@pytest.fixture(scope="module")
def whole(clip: Path) -> Path:
    """The track of the whole clip with its edits, made at once."""
    track = clip.with_name("whole.mtrk")
    told = solve_to(track, clip, edits=LOG)
    (refused,) = told.warnings
    assert refused.startswith(f"edit 5 (lock in frame {CUT + 2}) was left out: the polygon")
    return track


def test_what_was_made_lives_through_its_shot(whole: Path) -> None:
    with TrackReader(whole) as track:
        made = track.snapshot(AT)
        fresh = made.locks.vertices
        assert len(fresh) == 9
        assert len(made.locks.edges) == 1
        places = made.mesh.vertices[np.isin(made.mesh.vertex_ids, fresh)]
        assert [71.0, 22.0] in places.tolist()  # the spring lets nothing go
        for frame in range(COUNT):
            snapshot = track.snapshot(frame)
            assert_valid(snapshot.mesh)
            held = snapshot.locks
            if frame < CUT:
                assert np.isin(held.vertices, fresh).all()
                assert len(held.vertices) >= 6
            free = snapshot.mesh.triangle_count - held.extra(snapshot.mesh)
            assert abs(free - 40) <= 1  # what is held comes on top
        assert len(track.snapshot(CUT + 3).locks.vertices) == 1


def test_two_edited_frames_meet_half_way(clip: Path, tmp_path: Path) -> None:
    log = EditLog((Insert(1, (30.0, 32.0), 12.0, 5), Insert(5, (66.0, 32.0), 12.0, 5)))
    track = tmp_path / "two.mtrk"
    solve_to(track, clip, "0-5", edits=log)
    with TrackReader(track) as reader:
        found = [reader.snapshot(frame) for frame in range(6)]
    for snapshot in found:
        assert_valid(snapshot.mesh)
        assert abs(snapshot.mesh.triangle_count - 40) <= 22
    second = set(found[5].locks.vertices) - set(found[1].locks.vertices)
    assert len(second) == 5
    assert second <= set(found[4].locks.vertices)
    assert not second & set(found[1].mesh.vertex_ids.tolist())
    assert len(found[0].locks.vertices) == 5


def test_no_number_is_given_twice(whole: Path) -> None:
    """A vertex lives in frames that follow each other, also where time was run through twice."""
    lives: dict[int, list[int]] = {}
    with TrackReader(whole) as track:
        for frame in range(CUT):
            for vertex in track.snapshot(frame).mesh.vertex_ids.tolist():
                lives.setdefault(vertex, []).append(frame)
    assert all(life == list(range(life[0], life[-1] + 1)) for life in lives.values())


def test_others_give_the_same_bits(clip: Path, whole: Path, tmp_path: Path) -> None:
    """The log as a file, on two threads; shots one by one; a shot alone."""
    wanted = rows_of(whole)
    write_log(LOG, tmp_path / "log.jsonl")
    solve_to(tmp_path / "a.mtrk", clip, edits=read_log(tmp_path / "log.jsonl"), threads=2)
    assert rows_of(tmp_path / "a.mtrk") == wanted
    solve_to(tmp_path / "b.mtrk", clip, f"{CUT}-", edits=LOG)
    alone = rows_of(tmp_path / "b.mtrk")
    assert alone == {table: [r for r in rows if r[0] >= CUT] for table, rows in wanted.items()}


def test_a_random_log_leaves_all_frames_valid_and_comes_again(clip: Path, tmp_path: Path) -> None:
    """Some edits in any frame of both shots; `benchmarks/edit_logs.py` makes 2,000."""
    rng = np.random.default_rng(11)
    frames = rng.integers(0, COUNT, 24).tolist()
    log = EditLog(tuple(random_edit(rng, (96, 64), frame) for frame in frames))
    first = solve_to(tmp_path / "a.mtrk", clip, edits=log)
    assert 0 < len(first.warnings) < 18
    with TrackReader(tmp_path / "a.mtrk") as track:
        for frame in range(COUNT):
            assert_valid(track.snapshot(frame).mesh)
    lines = from_json_lines(as_json_lines(log), "log")
    again = solve_to(tmp_path / "b.mtrk", clip, edits=lines, threads=2)
    assert again.warnings == first.warnings
    assert rows_of(tmp_path / "b.mtrk") == rows_of(tmp_path / "a.mtrk")


class Interrupting(Progress):
    """Ctrl-C after some frames."""

    def __init__(self, after: int) -> None:
        super().__init__()
        self.after = after

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Interrupt at the frame."""
        if done == self.after:
            raise KeyboardInterrupt


@pytest.mark.parametrize("after", [AT + 2, CUT + 1])
def test_an_interrupted_job_goes_on(clip: Path, whole: Path, tmp_path: Path, after: int) -> None:
    track = tmp_path / "track.mtrk"
    with pytest.raises(KeyboardInterrupt):
        solve_to(track, clip, edits=LOG, progress=Interrupting(after))
    solve_to(track, clip, edits=LOG, resume=True)
    assert rows_of(track) == rows_of(whole)


def test_another_log_is_another_job(clip: Path, whole: Path) -> None:
    with pytest.raises(OptionError, match=r"--edits \(1 edits\) instead of \(5 edits\)"):
        solve_to(whole, clip, edits=EditLog(LOG.edits[:1]), resume=True)


def test_edits_that_cannot_be_made_change_nothing(clip: Path, tmp_path: Path) -> None:
    solve_to(tmp_path / "plain.mtrk", clip, "0-3")
    refused = EditLog((Insert(2, (400.0, 9.0), 5.0), FlipEdge(COUNT - 1, (4.0, 9.0))))
    told = solve_to(tmp_path / "edited.mtrk", clip, "0-3", edits=refused)
    assert rows_of(tmp_path / "edited.mtrk") == rows_of(tmp_path / "plain.mtrk")
    assert len(told.warnings) == 1
    assert f"edits of frame {COUNT - 1} change nothing: frames 0-3 are solved" in told.notes
    told = solve_to(tmp_path / "none.mtrk", clip, "0-3", edits=EditLog())
    assert "--edits: holds no edit, so nothing changes" in told.notes
    beyond = EditLog((FlipEdge(COUNT, (4.0, 9.0)),))
    with pytest.raises(OptionError, match=f"frame {COUNT} is edited, but .* ends with frame 11"):
        solve_to(tmp_path / "beyond.mtrk", clip, edits=beyond)


def gone(clip: Path, folder: Path, edit: Edit) -> tuple[int, int]:
    """Vertices inside of a circle in the last frame of a shot, without an edit and with it."""
    counts = []
    for edits in (EditLog(()), EditLog((edit,))):
        track = folder / f"{len(edits.edits)}.mtrk"
        solve_to(track, clip, f"0-{CUT - 1}", edits=edits)
        with TrackReader(track) as reader:
            vertices = reader.snapshot(CUT - 1).mesh.vertices
        counts.append(int((np.linalg.norm(vertices - (48, 32), axis=1) < 22).sum()))
    return counts[0], counts[1]


def test_what_was_taken_away_does_not_come_back(clip: Path, tmp_path: Path) -> None:
    before, after = gone(clip, tmp_path, Remove(1, (48.0, 32.0), 24.0, 40))
    assert after < before


@pytest.mark.parametrize(
    ("options", "told"),
    [({"independent": True}, "--independent"), ({"topology": "delaunay"}, "--topology energy")],
)
def test_what_does_not_go_together(clip: Path, options: dict[str, Any], told: str) -> None:
    if "topology" in options:
        options = {"triangulate": replace(QUICK, **options)}
    with pytest.raises(OptionError, match=told):
        job_of(clip, edits=EditLog((CollapseVertex(0, (1.0, 1.0)),)), **options)
