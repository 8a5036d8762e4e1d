"""Outputs of another shape than their source: whole or filled, with square pixels."""

from fractions import Fraction
from pathlib import Path

import av
import cv2
import media_samples as samples
import numpy as np
import pytest

from pipeline.cli import main
from stages.look.framing import Framing, framed, framing_of
from stages.look.output_size import NAMED_SIZES, parse_size
from stages.media import probe
from warp_kernels.errors import OptionError

QUICK = ["--triangles", "20", "--iterations", "2", "--progress", "none"]
RED = (255, 0, 0)


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("1280x720", (1280, 720)),
        ("1080x", (1080, 0)),
        ("X1080", (0, 1080)),
        ("4K", (3840, 2160)),
        *NAMED_SIZES.items(),
    ],
)
def test_forms_of_a_size(text: str, size: tuple[int, int]) -> None:
    """Both sides, one, or a name."""
    assert parse_size(text) == size


@pytest.mark.parametrize("text", ["", "x", "640", "0x10", "10x0", "-3x4", "axb", "8k", "1x2x3"])
def test_what_is_no_size(text: str) -> None:
    """No side, none that is 0, no other words."""
    with pytest.raises(ValueError, match=r".*"):
        parse_size(text)


@pytest.mark.parametrize("fit", ["contain", "cover"])
@pytest.mark.parametrize("aspect", [Fraction(1), Fraction(16, 15), Fraction(3, 5)])
@pytest.mark.parametrize("size", [(640, 640), (1080, 1920), (1920, 1080), (301, 77), (9, 400)])
def test_picture_keeps_its_shape(size: tuple[int, int], aspect: Fraction, fit: str) -> None:
    """Within a pixel; it lies in the middle, and touches or passes the sides that it shall."""
    source = (720, 480)
    found = framing_of(source, aspect, size, fit)
    (width, height), (across, down) = found.picture, found.offset
    assert found.canvas == size
    assert found.sample_aspect == 1
    shape = Fraction(source[0]) * aspect / source[1]
    assert abs(width - height * shape) <= max(1, shape)
    over = [side - out for side, out in zip(found.picture, size, strict=True)]
    assert 0 in over
    assert all(more >= 0 for more in over) if fit == "cover" else all(more <= 0 for more in over)
    assert abs(size[0] - width - 2 * across) <= 1
    assert abs(size[1] - height - 2 * down) <= 1


@pytest.mark.parametrize(
    ("size", "canvas"),
    [
        ((1080, 0), (1080, 720)),
        ((0, 1080), (1620, 1080)),
        ((100, 0), (100, 66)),
        ((101, 0), (101, 67)),
        ((9, 0), (9, 6)),
    ],
)
def test_other_side_follows(size: tuple[int, int], canvas: tuple[int, int]) -> None:
    """Even if the given one is."""
    assert framing_of((720, 480), Fraction(1), size, "cover").canvas == canvas


def test_nearly_the_same_shape_has_no_bars() -> None:
    """426.67 rows are 426 or 427; by two pixels it is another shape."""
    for height in (426, 427):
        assert framing_of((720, 480), Fraction(1), (640, height), "contain").is_plain
    assert not framing_of((720, 480), Fraction(1), (640, 424), "contain").is_plain


def test_impossible_framings() -> None:
    """A picture without a pixel, or one that nothing could hold."""
    with pytest.raises(OptionError, match="would be"):
        framing_of((8000, 2), Fraction(1), (640, 640), "contain")
    with pytest.raises(OptionError, match="--size x4000"):
        framing_of((8000, 2), Fraction(1), (0, 4000), "contain")


def test_canvas_around_and_within() -> None:
    """Bars have the background, or nothing; what is cut off is cut off on both sides."""
    picture = np.full((2, 4, 3), 9, np.uint8)
    wide = Framing((4, 5), (4, 2), Fraction(1))
    assert (framed(picture, wide, RED)[[0, 3, 4]] == RED).all()
    assert (framed(picture, wide, RED)[1:3] == 9).all()
    assert (framed(picture, wide, None)[0] == 0).all()
    clear = np.dstack([picture, np.zeros((2, 4), np.uint8)])
    assert framed(clear, wide, None).shape == (5, 4, 4)
    assert not framed(clear, wide, None)[..., 3].any()
    assert (framed(clear, wide, RED) == RED).all()
    picture[:] = np.arange(4)[:, None]
    assert framed(picture, Framing((2, 2), (4, 2), Fraction(1)), RED)[0, :, 0].tolist() == [1, 2]


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Two frames of 96x64 whose pixels are twice as wide as high: 3:1."""
    frames = [samples.picture(96, 64, seed) for seed in range(2)]
    return samples.write_video(tmp_path / "in.mp4", frames, aspect=Fraction(2))


@pytest.mark.parametrize(
    ("options", "size", "aspect"),
    [
        ("", (96, 64), 2),
        ("--scale 2", (192, 128), 2),
        ("--size 90x90", (90, 90), 1),
        ("--size 90x90 --fit cover", (90, 90), 1),
        ("--size 90x90 --fit stretch", (90, 90), 3),
        ("--size 120x", (120, 40), 1),
        ("--size x40", (120, 40), 1),
    ],
)
def test_pixels_are_squares(
    clip: Path, options: str, size: tuple[int, int], aspect: int, tmp_path: Path
) -> None:
    """But for `stretch`, and where no size is given."""
    out = tmp_path / "out.mp4"
    assert main(["animate", str(clip), "-o", str(out), *QUICK, *options.split()]) == 0
    info = probe(out)
    assert ((info.width, info.height), info.sample_aspect) == (size, aspect)


@pytest.mark.parametrize(
    ("options", "bar"),
    [
        ([], (0, 0, 0)),
        (["--background", "red"], RED),
        (["--style", "crosshatching:paper=#0f0"], (0, 255, 0)),
        (["--style", "paper:color=#00f,grain=0", "--style", "circles"], (0, 0, 255)),
        (["--style", "flat", "--style", "paper:color=#fff,blend=multiply"], (0, 0, 0)),
        (["--style", "circles"], None),
        (["--style", "circles", "--background", "#f00"], RED),
    ],
)
def test_colour_of_bars(clip: Path, options: list[str], bar: tuple | None, tmp_path: Path) -> None:
    """What is asked for, the paper of the look, nothing where the look is transparent, or black."""
    out = tmp_path / "out.png"
    more = ["--frames", "0", "--size", "90x90", *options]
    assert main(["animate", str(clip), "-o", str(out), *QUICK, *more]) == 0
    pixels = cv2.imread(str(out), cv2.IMREAD_UNCHANGED)
    assert pixels.shape == (90, 90, 3 + (bar is None))
    edge = pixels[0, 0, 2::-1] if bar else pixels[0, 0, 3:]
    assert edge.tolist() == list(bar or (0,))


def test_tracks_and_numbered_stills_are_fitted(clip: Path, tmp_path: Path) -> None:
    """By `render` as by `animate`, to the same bits."""
    track, names = tmp_path / "a.mtrk", [str(tmp_path / f"{name}_##.png") for name in "ab"]
    shape = ["--size", "54x96", "--fit", "cover"]
    assert main(["animate", str(clip), "-o", names[0], "--track", str(track), *QUICK, *shape]) == 0
    assert main(["render", str(track), "-o", names[1], "--progress", "none", *shape]) == 0
    one, other = (cv2.imread(name.replace("##", "01")) for name in names)
    assert one.shape == (96, 54, 3)
    assert np.array_equal(one, other)


def test_upright_clips_are_fitted_upright(tmp_path: Path) -> None:
    """A clip of a phone that lies in the file on its side."""
    frames = [samples.picture(96, 64, seed) for seed in range(2)]
    source = samples.write_video(tmp_path / "in.mp4", frames, rotation=90)
    out = tmp_path / "out.mp4"
    assert main(["animate", str(source), "-o", str(out), *QUICK, "--size", "x96"]) == 0
    with av.open(str(out)) as opened:
        frame = next(opened.decode(video=0))
        assert (frame.width, frame.height) == (64, 96)
