"""Pictures stored lying, upside down or mirrored are shown as a player shows them."""

from fractions import Fraction
from itertools import product
from pathlib import Path

import media_samples as samples
import numpy as np
import pytest
from PIL import Image, ImageOps
from test_encode import convert

from pipeline.commands.info import describe
from stages.media import open_decoder, probe
from stages.media.orientation import Orientation, orientation_from

WAYS = [(a, 0, 0, d) for a, d in product((1, -1), repeat=2)]
WAYS += [(0, b, c, 0) for b, c in product((1, -1), repeat=2)]
"""The eight ways to show a picture: a stored point (x, y) is shown at (a x + c y, b x + d y)."""


def moved(pixels: np.ndarray, way: tuple[int, int, int, int]) -> np.ndarray:
    """A picture shown in one of the ways, point by point."""
    a, b, c, d = way
    rows, columns = np.indices(pixels.shape[:2])
    x, y = a * columns + c * rows, b * columns + d * rows
    x, y = x - x.min(), y - y.min()
    shown = np.zeros((y.max() + 1, x.max() + 1, 3), np.uint8)
    shown[y, x] = pixels
    return shown


@pytest.mark.parametrize("way", WAYS)
def test_videos_are_shown_as_their_matrix_says(
    tmp_path: Path, way: tuple[int, int, int, int]
) -> None:
    """Turned and mirrored ones, with pixels that are not square."""
    pictures = [samples.picture(64, 48, n) for n in range(3)]
    path = samples.write_video(
        tmp_path / "in.mp4", pictures, matrix="bt709", way=way, aspect=Fraction(2)
    )
    with open_decoder(path) as decoder:
        frames = [frame.pixels for frame in decoder]
        assert decoder.info.sample_aspect == (2 if way[0] else Fraction(1, 2))
    for frame, picture in zip(frames, pictures, strict=True):
        assert frame.shape == moved(picture, way).shape
        assert np.abs(frame.astype(int) - moved(picture, way)).mean() < 4


@pytest.mark.parametrize("name", ["a.jpg", "a.png", "a.tif", "a.webp"])
def test_all_exif_orientations(tmp_path: Path, name: str) -> None:
    """Eight of them, as Pillow shows them."""
    for number in range(1, 9):
        path = tmp_path / f"{number}_{name}"
        exif = Image.Exif()
        exif[0x0112] = number
        Image.fromarray(samples.picture(64, 48)).save(path, exif=exif, quality=95, lossless=True)
        expected = np.asarray(ImageOps.exif_transpose(Image.open(path)).convert("RGB"))
        with open_decoder(path) as decoder:
            (frame,) = decoder
        assert frame.pixels.shape == expected.shape
        assert np.abs(frame.pixels.astype(int) - expected).mean() < 2


def test_a_mirrored_clip_is_written_as_it_is_shown(tmp_path: Path) -> None:
    """Nothing is left to mirror in the output, and `info` tells of the input."""
    pictures = [samples.picture(64, 48, n) for n in range(3)]
    source = samples.write_video(tmp_path / "in.mp4", pictures, way=(0, -1, -1, 0))
    convert(source, tmp_path / "out.mp4")
    assert probe(source).orientation == Orientation(90, True)
    assert probe(tmp_path / "out.mp4").orientation == Orientation()
    assert "turned by 90, mirrored" in describe(source, as_json=False)


def test_every_still_is_turned_by_itself(tmp_path: Path) -> None:
    """A camera may have been turned upside down between two stills."""
    for number, orientation in enumerate((1, 3)):
        exif = Image.Exif()
        exif[0x0112] = orientation
        Image.fromarray(samples.picture(64, 48)).save(tmp_path / f"s_{number:02}.png", exif=exif)
    with open_decoder(tmp_path / "s_##.png") as decoder:
        first, second = decoder
    assert np.array_equal(second.pixels, first.pixels[::-1, ::-1])


@pytest.mark.parametrize("degrees", range(0, 360, 10))
def test_other_turns_go_to_the_nearest(degrees: int) -> None:
    """A phone held a little aslant, mirrored or not."""
    turn = np.radians(degrees)
    cos, sin = np.cos(turn), np.sin(turn)
    nearest = round((degrees + 1e-6) / 90) % 4 * 90
    if degrees % 90 != 45:
        assert orientation_from(cos, -sin, sin, cos) == Orientation(nearest, False)
        assert orientation_from(-cos, -sin, -sin, cos) == Orientation(nearest, True)
