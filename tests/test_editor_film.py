"""What the editor does with a film: edits reach through shots, frames and films are written."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from pipeline.cli import main
from pipeline.editor.bench.easel import look_of
from pipeline.editor.bench.errands import CancelledError, beside, ground_of
from pipeline.editor.bench.long_work import Applying, Rendering
from pipeline.editor.bench.session import Session
from pipeline.track import TrackReader
from stages.hand.insert import Insert
from stages.hand.regions.style_region import StyleRegion
from stages.hand.split_triangle import SplitTriangle
from stages.media import open_decoder
from tests.editing import opened, write_clip_job
from tests.tracks import CUT, QUICK_FLAGS, rows_of
from warp_kernels.errors import EditError, OptionError, OutputError

FIRST, SECOND = Insert(3, (40.0, 30.0), 12.0, 3), SplitTriangle(CUT + 2, (60.0, 40.0))


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clip's track."""
    return write_clip_job(tmp_path_factory.mktemp("film"))


@pytest.fixture
def session(solved: Path, tmp_path: Path) -> Iterator[Session]:
    """A session on a copy of it."""
    found = opened(Path(shutil.copy(solved, tmp_path / "clip.mtrk")))
    yield found
    found.close()


def apply(session: Session, frame: int | None = None) -> list[tuple[int, int]]:
    """Let the edits reach through the shot of a frame, or all; what was told of it."""
    told: list[tuple[int, int]] = []
    shots = session.film.pending(session.log)
    if frame is not None:
        shots = [one for one in session.film.shots if one.first <= frame <= one.last]
    notes = Applying(session, shots, session.log).run(lambda *at: told.append(at), lambda: False)
    assert notes == ()
    session.renewed()
    return told


def headless(session: Session, tmp_path: Path) -> dict[str, list[tuple]]:
    """The same by the command line: rows of its track."""
    again = tmp_path / "again.mtrk"
    words = ["solve", str(session.options.source), *QUICK_FLAGS, "--edits", str(session.path)]
    assert main([*words, "-o", str(again), "--overwrite"]) == 0
    return rows_of(again)


def test_edits_reach_through_their_shots_as_without_the_editor(
    session: Session, tmp_path: Path
) -> None:
    """To the bit: of one shot, of both, and after an undo."""
    before = rows_of(session.path)
    session.make([FIRST, SECOND], after=0)
    assert session.state()["pending"] == [0, CUT]
    told = apply(session, frame=3)
    assert told[-1] == (CUT, CUT)
    assert session.state()["pending"] == [CUT]
    assert rows_of(session.path)["frames"][CUT:] == before["frames"][CUT:]
    apply(session)
    assert session.state()["pending"] == []
    assert rows_of(session.path) == headless(session, tmp_path)
    assert rows_of(ground_of(session.path)) == before
    session.undo()
    assert session.state()["pending"] == [CUT]
    apply(session)
    assert rows_of(session.path) == headless(session, tmp_path)


def test_a_frame_is_seen_before_while_and_after(session: Session) -> None:
    """What one edits is the frame with one's edits, and not what the film made of it."""
    before = session.shown(3).mesh
    session.make([FIRST], after=0)
    edited = session.shown(3).mesh
    apply(session)
    assert np.array_equal(session.shown(3, view="before").mesh.vertices, before.vertices)
    assert np.array_equal(session.shown(3).mesh.vertices, edited.vertices)
    film = session.shown(3, view="solved")
    assert len(film.locks.vertices) == len(edited.vertices) - len(before.vertices)
    assert len(session.shown(5, view="solved").locks.vertices) > 0
    session.undo()
    assert np.array_equal(session.shown(3).mesh.vertices, before.vertices)


def test_windows_on_other_frames_are_in_nobody_s_way(session: Session) -> None:
    """What the other one did is no reason to refuse an edit, but of the same frame it is."""
    here, there = (SplitTriangle(frame, (40.0, 30.0)) for frame in (2, 9))
    first = session.make([here], after=0)
    second = session.make([there], after=0)
    live = session.optimise(2, {})
    with pytest.raises(EditError, match="another window went on"):
        session.make([replace(here, at=(70.0, 50.0))], after=0, in_live=True)
    assert session.optimise(2, {}) is not live  # in which that edit was made
    session.undo()
    with pytest.raises(EditError, match="another window went on"):
        session.make([there], after=second)
    assert session.make([there], after=first) == second + 1


def test_what_is_cancelled_changes_nothing(session: Session) -> None:
    session.make([FIRST], after=0)
    before = session.path.read_bytes()
    work = Applying(session, session.film.shots, session.log)
    with pytest.raises(CancelledError):
        work.run(lambda *_: None, lambda: True)
    assert session.path.read_bytes() == before
    assert sorted(p.name for p in session.path.parent.iterdir() if p.suffix) == ["clip.mtrk"]


def test_frames_and_films_are_written(session: Session, tmp_path: Path) -> None:
    """As the output has them; nothing that is there is written over."""
    look = look_of(["flat", "edges"])
    film, frame = tmp_path / "film.mkv", tmp_path / "frame.png"
    Rendering(session, look, film).run(lambda *_: None, lambda: False)
    with open_decoder(film) as decoder:
        assert sum(1 for _ in decoder) == 12
    session.export(3, look, frame)
    assert np.array_equal(np.asarray(Image.open(frame)), session.drawn(3, look))
    with pytest.raises(OutputError, match="exists"):
        session.export(3, look, frame)
    with pytest.raises(OutputError, match="exists"):
        Rendering(session, look, film).run(lambda *_: None, lambda: False)


@pytest.mark.parametrize("name", ["", "../a.mp4", "/etc/a.mp4", "a/b.mp4", ".hidden", "a\nb.png"])
def test_names_of_files_lead_nowhere_else(name: str, tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="give the name of a file"):
        beside(tmp_path / "job.mtrk", name)


def test_a_ground_of_another_film_is_not_taken(session: Session, solved: Path) -> None:
    """One that was solved in another way, or is damaged, is as if it were not there."""
    session.make([FIRST], after=0)
    apply(session)
    assert session.film.has_ground
    ground_of(session.path).write_bytes(b"nothing")
    session.renewed()
    assert not session.film.has_ground
    words = ["solve", str(session.options.source), *QUICK_FLAGS, "--seed", "7"]
    assert main([*words, "-o", str(ground_of(session.path)), "--overwrite"]) == 0
    session.renewed()
    assert not session.film.has_ground


def test_frames_are_drawn_as_wide_as_they_are_seen(session: Session) -> None:
    """While a film plays; never wider than it is."""
    look = look_of(["flat"])
    assert session.drawn(3, look, across=48).shape[1] == 48
    assert session.drawn(3, look, across=9_999).shape == session.drawn(3, look).shape


def test_thumbnails_are_small(session: Session) -> None:
    assert session.thumbnail(3).shape[2] == 3
    assert max(session.thumbnail(3).shape) <= 128


def test_the_track_stays_one(session: Session) -> None:
    """All of its frames can be read after edits were applied, and it can be resumed."""
    session.make([FIRST, SECOND], after=0)
    apply(session)
    with TrackReader(session.path) as track:
        track.check()
        assert track.header.finished
        assert track.header.solve.edits is not None
        assert set(track.header.solve.edits.edits) == {FIRST, SECOND}


@pytest.mark.parametrize("frame", [3, 5, CUT])
def test_painted_regions_are_drawn_as_by_render(
    session: Session, tmp_path: Path, frame: int
) -> None:
    """In the frame in which they were painted, later in its shot, and not in the next one."""
    plain = session.drawn(frame, look_of([]))
    painted = StyleRegion(frame=3, at=(40.0, 30.0), radius=20.0, style="edges:width=3")
    session.make([painted], after=0)
    assert session.state()["pending"] == []  # the meshes are as they were
    still = tmp_path / "frame.png"
    words = ["render", str(session.path), "-o", str(still), "--frames", str(frame)]
    assert main(words) == 0
    drawn = session.drawn(frame, look_of([]))
    assert np.array_equal(drawn, np.asarray(Image.open(still)))
    assert np.array_equal(drawn, plain) == (frame == CUT)


def test_a_style_that_there_is_not_is_not_painted(session: Session) -> None:
    with pytest.raises(OptionError, match="did you mean edges"):
        session.make([StyleRegion(frame=3, at=(40.0, 30.0), radius=9.0, style="edgs")], after=0)
    assert session.state()["edits"] == 0
