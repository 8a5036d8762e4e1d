"""Ranges of frames and times, and names of numbered stills."""

from fractions import Fraction
from pathlib import Path

import pytest

from stages.media import FrameRange, NumberedPattern, parse_time
from stages.media.timing import TimeRepair
from warp_kernels.errors import OptionError


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("3-7", FrameRange(3, 7)),
        ("5", FrameRange(5, 5)),
        ("4-", FrameRange(4)),
        ("0-10x4", FrameRange(0, 10, 4)),
        ("2-x3", FrameRange(2, None, 3)),
    ],
)
def test_forms_of_a_range(text: str, expected: FrameRange) -> None:
    """Every documented form is read."""
    assert FrameRange.parse(text) == expected


@pytest.mark.parametrize("text", ["1:5", "7-3", "", "a", "-4", "3-5x0", "1-2-3", "1.5"])
def test_bad_ranges_are_refused(text: str) -> None:
    """What is no range is an error that says so."""
    with pytest.raises(OptionError):
        FrameRange.parse(text)


def test_colon_is_explained() -> None:
    """Users of other programs learn what to write."""
    with pytest.raises(OptionError, match="write A-B"):
        FrameRange.parse("10:20")


def test_both_ends_are_included() -> None:
    """A-BxS holds A, A+S, ... up to B."""
    wanted = FrameRange.parse("2-8x3")
    assert [n for n in range(12) if wanted.holds(n, Fraction(n))] == [2, 5, 8]


def test_times_bound_a_range() -> None:
    """Start and end times are both included."""
    wanted = FrameRange.parse("0-", "1", "2")
    assert [n for n in range(20) if wanted.holds(n, Fraction(n, 4))] == [4, 5, 6, 7, 8]


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("12.5", Fraction(25, 2)),
        ("12.5s", Fraction(25, 2)),
        ("40 ms", Fraction(1, 25)),
        ("1:02.5", Fraction(125, 2)),
        ("1:00:01", Fraction(3601)),
    ],
)
def test_times(text: str, seconds: Fraction) -> None:
    """Seconds and clocks are read exactly."""
    assert parse_time(text) == seconds


@pytest.mark.parametrize("text", ["", "x", "-1", "1:2:3:4", "1:", "s", "1:00s", "2m"])
def test_bad_times_are_refused(text: str) -> None:
    """What is no time is an error."""
    with pytest.raises(OptionError):
        parse_time(text)


@pytest.mark.parametrize("name", ["shot_####.png", "shot_%04d.png", "shot_$F4.png"])
def test_three_ways_to_write_a_pattern(name: str) -> None:
    """All three mean the same file names."""
    pattern = NumberedPattern.parse(f"out/{name}")
    assert pattern is not None
    assert pattern.path_for(7) == Path("out/shot_0007.png")
    assert pattern.path_for(123456) == Path("out/shot_123456.png")


def test_plain_names_are_no_pattern() -> None:
    """A name without a field is a file."""
    assert NumberedPattern.parse("shot_01.png") is None


def test_two_fields_are_refused() -> None:
    """It would not be clear which one is the frame."""
    with pytest.raises(OptionError, match="2 number fields"):
        NumberedPattern.parse("a_##_b_##.png")


def test_increasing_times_pass_unchanged() -> None:
    """Uneven but increasing times are nobody's mistake."""
    repair = TimeRepair(40)
    times = [0, 40, 41, 500, 100000, 100040]
    assert [repair(t, 40) for t in times] == times
    assert repair.repaired == 0


def test_one_step_back_is_moved_forward() -> None:
    """A single frame out of order does not shift those after it."""
    repair = TimeRepair(40)
    assert [repair(t, 40) for t in (0, 40, 80, 0, 160)] == [0, 40, 80, 120, 160]
    assert repair.repaired == 1


def test_missing_times_follow_the_frame_rate() -> None:
    """Bare streams have no times at all."""
    repair = TimeRepair(40)
    assert [repair(None, 0) for _ in range(4)] == [0, 40, 80, 120]


def test_time_goes_on_after_a_restart() -> None:
    """A clock that falls back to zero is joined to what came before."""
    repair = TimeRepair(40)
    out = [repair(t, 40) for t in (1000, 1040, 0, 40, 80, 120)]
    assert out == [1000, 1040, 1080, 1120, 1160, 1200]
