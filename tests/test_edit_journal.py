"""The journal of edits in a track: undo, redo, branches, two windows, kills, strangers' files."""

import shutil
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.cli import main
from pipeline.edit_log.journal import EditJournal
from pipeline.edit_log.json_lines import as_json_lines
from pipeline.edit_log.read import read_log
from pipeline.options.edit_log import EditLog
from stages.hand import Edit
from stages.hand.split_triangle import SplitTriangle
from tests.tracks import rows_of, solve_to, write_clip
from warp_kernels.errors import EditError, OptionError, TrackError

SOLVED = EditLog((SplitTriangle(0, (48.0, 32.0)),))
"""The log with which the track was solved."""


def edit(number: int) -> Edit:
    """Some edit."""
    return SplitTriangle(0, (float(number % 96), float(number // 96)))


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A track of one frame that was edited."""
    folder = tmp_path_factory.mktemp("journal")
    track = folder / "job.mtrk"
    solve_to(track, write_clip(folder / "in.mp4"), "0-0", edits=SOLVED)
    return track


@pytest.fixture
def track(solved: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copy(solved, tmp_path / "job.mtrk"))


def test_it_begins_with_the_log_of_the_frames(track: Path) -> None:
    before = track.read_bytes()
    assert read_log(track) == SOLVED
    assert track.read_bytes() == before  # who only looks changes nothing
    rows = rows_of(track)
    with EditJournal(track) as journal:
        assert (journal.number, journal.log, journal.can_redo) == (1, SOLVED, False)
        assert journal.undo() == SOLVED.edits[0]
        assert (journal.number, journal.log, journal.can_redo) == (0, EditLog(), True)
        assert journal.undo() is None
        assert journal.redo() == SOLVED.edits[0]
        assert journal.redo() is None
        assert journal.log == SOLVED
    assert rows_of(track) == rows


@settings(max_examples=8, deadline=None)
@given(
    steps=st.lists(
        st.one_of(
            st.integers(1, 3), st.sampled_from(["undo", "redo", "reopen"]), st.integers(-9, -1)
        ),
        max_size=16,
    )
)
def test_any_history_is_that_of_a_model(
    solved: Path, tmp_path_factory: pytest.TempPathFactory, steps: list[int | str]
) -> None:
    """Numbers above zero append as many, those below go to any edit that ever was."""
    track = Path(shutil.copy(solved, tmp_path_factory.mktemp("model") / "job.mtrk"))
    made: dict[int, tuple[int, Edit]] = {1: (0, SOLVED.edits[0])}
    been, here = [1], 1
    journal = EditJournal(track)
    for step in steps:
        if step == "undo":
            assert journal.undo() == (made[here][1] if here else None)
            here = made[here][0] if here else 0
        elif step == "redo":
            newest = next((n for n in reversed(been) if n and made[n][0] == here), None)
            assert journal.redo() == (made[newest][1] if newest else None)
            here = newest or here
        elif step == "reopen":
            journal.close()
            journal = EditJournal(track)
        elif int(step) < 0:
            here = -int(step) % (len(made) + 1)
            journal.go_to(here)
        else:
            fresh = [edit(len(made) + n) for n in range(int(step))]
            journal.append(fresh, after=here)
            for one in fresh:
                made[len(made) + 1] = (here, one)
                here = len(made)
                been.append(here)
        been.append(here)
        chain, at = [], here
        while at:
            at, one = made[at]
            chain.append(one)
        assert journal.log == EditLog(tuple(chain[::-1]))
    kept = {kept.number: (kept.follows, kept.edit) for kept in journal.history}
    journal.close()
    assert kept == made  # nothing is ever lost


def test_two_windows_see_each_other(track: Path) -> None:
    with EditJournal(track) as one, EditJournal(track) as other:
        assert one.append([edit(1), edit(2)], after=1) == 3
        assert other.log == one.log
        with pytest.raises(EditError, match="edit 3 is the last one in force, not edit 1"):
            other.append([edit(3)], after=1)
        other.undo()
        assert other.append([edit(3)]) == 4
        assert one.since(1) == (edit(1), edit(3))
        assert one.since(4) == ()
        assert one.since(3) is None  # which was undone
        assert one.log.edits == (*SOLVED.edits, edit(1), edit(3))
        with pytest.raises(EditError, match="no edit 5; numbers go from 0 to 4"):
            one.go_to(5)


KILLED = """
import sys
from pathlib import Path
from pipeline.edit_log.journal import EditJournal
from stages.hand.split_triangle import SplitTriangle
journal = EditJournal(Path(sys.argv[1]))
for number in range(100000):
    one = SplitTriangle(0, (float(number % 96), float(number // 96)))
    print(journal.append([one]), flush=True)
"""


def test_what_was_acknowledged_survives_a_kill(track: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(track)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        told = [process.stdout.readline() for _ in range(5)]
        process.send_signal(signal.SIGKILL)
        told += process.stdout.read().splitlines(keepends=True)
    acknowledged = int([line for line in told if line.endswith("\n")][-1])
    with EditJournal(track) as journal:
        number = journal.number
        assert acknowledged <= number <= acknowledged + 1
        assert journal.log == EditLog((*SOLVED.edits, *map(edit, range(number - 1))))
        journal.append([edit(7)])


def test_the_command_line_reads_it(track: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with EditJournal(track) as journal:
        journal.append([edit(5)])
        wanted = journal.log
    assert main(["info", str(track), "--edits"]) == 0
    assert capsys.readouterr().out == as_json_lines(wanted)
    again, clip = track.with_name("again.mtrk"), write_clip(track.with_name("in.mp4"))
    solve_to(again, clip, "0-0", edits=read_log(track))
    assert read_log(again) == wanted
    assert main(["info", str(again)]) == 0
    assert "edits      2, which --edits prints" in capsys.readouterr().out
    assert main(["info", str(clip), "--edits"]) == 2
    assert "is no mesh track" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("UPDATE edits SET follows = number", "follows 1, which is not there"),
        ("UPDATE edits SET edit = '{}'", "edit 1 is none"),
        ("UPDATE edits SET edit = edit || char(10) || edit", "edit 1 is none"),
        ("UPDATE edits SET edit = x'00'", "edit 1 is no text"),
        ("INSERT INTO edit_places (number) VALUES (99)", "edit 99 is in force and is not there"),
        ("INSERT INTO edit_places (number) VALUES ('x')", "'x' is in force"),
        ("DROP TABLE edits", "no such table"),
    ],
)
def test_strangers_journals_are_refused(track: Path, change: str, told: str) -> None:
    with EditJournal(track) as journal:
        journal.append([])
    with closing(sqlite3.connect(track)) as connection:
        connection.execute(change)
        connection.commit()
    with pytest.raises((TrackError, OptionError), match=told):
        read_log(track)
