"""Cuts are found where they are, and nothing else is taken for one."""

from pathlib import Path

import numpy as np
import pytest

from pipeline.loop.shots import with_shots
from pipeline.track.cuts import read_cuts
from tests.kernel_samples import frame_of, noise, waves
from warp_kernels.errors import MediaError, OptionError

FIRST = waves(64, 48)
SECOND = 255 - FIRST[::-1, ::-1]
DETAILED = np.kron(noise(16, 12), np.ones((6, 6, 1), dtype=np.uint8))
WHITE = np.full_like(FIRST, 255)


def starts(pictures: list[np.ndarray], cuts: str = "auto") -> list[int]:
    """The frames with which shots open."""
    frames = [frame_of(picture, number) for number, picture in enumerate(pictures)]
    shots = list(with_shots(iter(frames), cuts))
    assert [shot.frame for shot in shots] == frames
    return [shot.frame.index for shot in shots if shot.opens_shot]


def panned(count: int, picture: np.ndarray = FIRST) -> list[np.ndarray]:
    """A slow pan over a picture, with a little noise."""
    rng = np.random.default_rng(1)
    moved = [np.roll(picture, number, axis=1).astype(int) for number in range(count)]
    noisy = [frame + rng.integers(-3, 4, frame.shape) for frame in moved]
    return [np.clip(frame, 0, 255).astype(np.uint8) for frame in noisy]


@pytest.mark.parametrize("at", [1, 2, 7, 11])
def test_hard_cut_opens_a_shot(at: int) -> None:
    """Also right after the start and just before the end."""
    assert starts(panned(at) + panned(12 - at, SECOND)) == [0, at]


def test_two_cuts_near_each_other_are_both_found() -> None:
    """A shot of four frames between two others."""
    third = np.full_like(FIRST, 20)
    pictures = panned(8) + panned(4, SECOND) + [third] * 8
    assert starts(pictures) == [0, 8, 12]


@pytest.mark.parametrize("length", [1, 2, 3])
def test_flash_is_no_cut(length: int) -> None:
    """White frames after which the same shot goes on open nothing, neither coming nor going."""
    assert starts(panned(6) + [WHITE] * length + panned(8)) == [0]


def test_dissolve_is_no_cut() -> None:
    """A fade from one picture to another over twelve frames is no hard cut."""
    shares = np.linspace(0, 1, 12)
    between = [((1 - s) * FIRST + s * SECOND).astype(np.uint8) for s in shares]
    assert starts([FIRST] * 5 + between + [SECOND] * 5) == [0]


@pytest.mark.parametrize("count", [4, 12])
def test_fade_through_black_is_no_cut(count: int) -> None:
    """A picture fades out, and another one in."""
    shares = np.linspace(0, 1, count, endpoint=False)[1:]
    out = [(FIRST * (1 - share)).astype(np.uint8) for share in shares]
    into = [(SECOND * share).astype(np.uint8) for share in shares]
    black = [np.zeros_like(FIRST)] * 3
    assert starts([FIRST] * 5 + out + black + into + [SECOND] * 5) == [0]


@pytest.mark.parametrize("step", [8, 16])
def test_fast_pan_is_no_cut(step: int) -> None:
    """Neither its sudden start nor its end: the picture is the same, elsewhere."""
    moved = [np.roll(DETAILED, number * step, axis=1) for number in range(6)]
    assert starts([moved[0]] * 6 + moved + [moved[-1]] * 6) == [0]


def test_motion_of_repeated_frames_is_no_cut() -> None:
    """Ten pictures a second, each shown three times: every third step is a large one."""
    moved = [np.roll(DETAILED, number * 10, axis=1) for number in range(8)]
    assert starts([picture for picture in moved for _ in range(3)]) == [0]


def test_light_is_no_cut() -> None:
    """A lamp is switched on: the same things are seen."""
    assert starts([(DETAILED * 0.4).astype(np.uint8)] * 6 + [DETAILED] * 6) == [0]


def test_plain_pictures_of_different_colours_are_cut() -> None:
    """Titles on plain grounds have nothing that could be looked for but their colour."""
    plain = [np.full_like(FIRST, level) for level in (20, 140)]
    assert starts([plain[0]] * 5 + [plain[1]] * 5) == [0, 5]
    assert starts([plain[0]] * 5 + [FIRST] * 5) == [0, 5]


def test_pan_and_still_are_no_cut() -> None:
    """Motion and noise open nothing, nor does a picture that stands still."""
    assert starts(panned(15)) == [0]
    assert starts([FIRST] * 6) == [0]


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_short_clips(count: int) -> None:
    """Every frame comes through, however few there are."""
    assert starts([FIRST] * count) == [0][:count]


def test_none_ignores_cuts() -> None:
    """With `none` only the first frame opens a shot."""
    assert starts(panned(4) + panned(4, SECOND), "none") == [0]


def test_first_frame_opens_a_shot_wherever_the_range_begins(tmp_path: Path) -> None:
    """A range that starts at frame 5 has its first shot there."""
    listed = tmp_path / "cuts.txt"
    listed.write_text("7")
    frames = [frame_of(FIRST, number) for number in range(5, 9)]
    for cuts, expected in (("auto", [5]), ("none", [5]), (str(listed), [5, 7])):
        shots = with_shots(iter(frames), cuts)
        assert [s.frame.index for s in shots if s.opens_shot] == expected


@pytest.mark.parametrize(
    "text", ["[3, 6]", "3\n6\n", "3 6", " \n[6,\n 3, 3]", "6\r\n3", "0\n3\n6\n999"]
)
def test_forms_of_a_list(text: str, tmp_path: Path) -> None:
    """JSON or numbers, in any order; what the clip does not have is ignored."""
    path = tmp_path / "cuts"
    path.write_text(text)
    assert starts([FIRST] * 8, str(path)) == [0, 3, 6]


@pytest.mark.parametrize("text", ["", "[]", "\n"])
def test_empty_list_has_no_cut(text: str, tmp_path: Path) -> None:
    """An empty list is a list."""
    path = tmp_path / "cuts"
    path.write_text(text)
    assert read_cuts(path) == frozenset()


@pytest.mark.parametrize(
    "text", ["4, 8", "x", "[3", "[[3]]", '{"a": 3}', "-1", "[null]", "1.5", "[1e999]", "[2.5]"]
)
def test_bad_list_is_named(text: str, tmp_path: Path) -> None:
    """One line that names the file and says what it should hold."""
    path = tmp_path / "cuts.json"
    path.write_text(text)
    with pytest.raises(MediaError, match=r"cuts\.json: .*; list the first frame") as caught:
        read_cuts(path)
    assert "\n" not in str(caught.value)


def test_unreadable_list_is_named(tmp_path: Path) -> None:
    """A list that is missing, a folder or no text is an error of that file."""
    binary = tmp_path / "picture.png"
    binary.write_bytes(b"\x89PNG\xff\xfe")
    for path in (tmp_path / "missing.txt", tmp_path, binary):
        with pytest.raises(MediaError, match="cannot be read"):
            read_cuts(path)
    with pytest.raises(OptionError, match="--cuts"):
        with_shots([], "")
