"""Runs in trouble: some of what `benchmarks/failures` tries, as it stands on a user's machine."""

from pathlib import Path

import pytest

from benchmarks.failures.disks import disk_of, resize
from benchmarks.failures.films import QUICK, QUIET, content_of, done, is_one_line
from benchmarks.failures.places import ANIMATE, CHANGES, SOLVE, changed
from pipeline.cli import main
from tests.tracks import write_clip


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a film."""
    folder = tmp_path_factory.mktemp("failures")
    write_clip(folder / "film.mp4")
    return folder


def test_a_full_disk_costs_nothing_that_was_solved(given: Path) -> None:
    """One line and exit code 4; with more room it goes on to the same bits."""
    with disk_of(given / "disk", 48 * 1024) as may:
        if not may:
            pytest.skip("this user may not make a disk in memory")
        track, again = given / "disk" / "a.mtrk", given / "b.mtrk"
        solve = [str(word) for word in ("solve", given / "film.mp4", *QUICK, *QUIET, "-o")]
        code, said = done((*solve, track), given)
        assert code == 4, said
        assert is_one_line(said), said
        assert main(["info", str(track)]) == 0
        resize(given / "disk", 1 << 26)
        assert main([*solve, str(track), "--resume"]) == 0
        assert main([*solve, str(again)]) == 0
        assert content_of(track) == content_of(again)


@pytest.mark.parametrize(
    ("words", "change"),
    [
        (SOLVE, "output folder removed"),
        (ANIMATE, "output folder removed"),
        (SOLVE, "source emptied"),
    ],
    ids=["solve", "animate", "source"],
)
def test_what_vanishes_meanwhile_is_told(words: tuple[str, ...], change: str, given: Path) -> None:
    """No traceback, nothing half-written: one line, or all is well since it was read before."""
    assert changed(given, words, CHANGES[change]) == ""
