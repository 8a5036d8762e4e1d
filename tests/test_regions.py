"""Styles inside of masks: where the mask is white and nowhere else, frame by frame."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.cli import main
from tests.golden_images import write_png
from tests.tracks import write_clip
from warp_kernels.styles import STYLES

QUICK = ("--iterations", "2", "--frame-iterations", "2", "--triangles", "40", "--progress", "none")
WIDTH, HEIGHT = 96, 64
RED = "paper:color=#f00,grain=0,sheets=0"


@pytest.fixture(scope="module")
def track(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the track of four frames."""
    folder = tmp_path_factory.mktemp("regions")
    clip = write_clip(folder / "in.mp4")
    target = folder / "in.mtrk"
    assert main(["solve", str(clip), "-o", str(target), "--frames", "0-3", *QUICK]) == 0
    return target


def half(columns: slice) -> np.ndarray:
    """A mask that is white in some columns, [H, W, 3] uint8."""
    mask = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    mask[:, columns] = 255
    return mask


def drawn(track: Path, folder: Path, *look: str) -> dict[int, np.ndarray]:
    """Frames of a look, as RGB."""
    folder.mkdir()
    out = ["-o", str(folder / "f_%01d.png"), "--progress", "none"]
    assert main(["render", str(track), *out, *look]) == 0
    return {
        int(path.stem[-1]): cv2.imread(str(path))[..., ::-1].astype(int)
        for path in sorted(folder.iterdir())
    }


def test_still_mask_holds_for_all_frames(track: Path, tmp_path: Path) -> None:
    """White: the style; black: what is below, to the bit; grey: a part of both."""
    mask = half(slice(0, 30))
    mask[:, 30:40] = 128
    write_png(tmp_path / "a: mask.png", mask)
    plain = drawn(track, tmp_path / "plain")
    found = drawn(track, tmp_path / "found", "--region", f"{tmp_path / 'a: mask.png'}:{RED}")
    assert list(found) == [0, 1, 2, 3]
    for number, pixels in found.items():
        assert (pixels[:, :29] == (255, 0, 0)).all()
        np.testing.assert_array_equal(pixels[:, 41:], plain[number][:, 41:])
        mixed = plain[number] + 128 / 255 * (np.array([255, 0, 0]) - plain[number])
        assert np.abs(pixels - mixed)[:, 31:39].max() <= 1.5


def test_moving_mask_belongs_to_its_frame(track: Path, tmp_path: Path) -> None:
    """Numbered stills, also where the range begins later; over a region lies the next one."""
    for number in range(4):
        write_png(tmp_path / f"m_{number}.png", half(slice(10 * number, 10 * number + 20)))
    region = ["--region", f"{tmp_path / 'm_%01d.png'}:{RED}"]
    write_png(
        tmp_path / "top.png",
        half(slice(0, 96))[:, :, ::-1] * (np.arange(64) < 8)[:, None, None].astype(np.uint8),
    )
    blue = ["--region", f"{tmp_path / 'top.png'}:paper:color=#00f,grain=0,sheets=0"]
    found = drawn(track, tmp_path / "found", "--frames", "2-3", *region, *blue)
    assert list(found) == [2, 3]
    for number, pixels in found.items():
        assert (pixels[10:, 10 * number + 1 : 10 * number + 19] == (255, 0, 0)).all()
        assert not (pixels[10:, : 10 * number - 1] == (255, 0, 0)).all(axis=2).any()
        assert (pixels[:7] == (0, 0, 255)).all()


def test_regions_of_animate_are_those_of_render(tmp_path: Path) -> None:
    """Solved and drawn at once, with a style that needs slopes and the source."""
    clip = write_clip(tmp_path / "in.mp4")
    write_png(tmp_path / "m.png", half(slice(0, 48)))
    look = [
        "--region",
        f"{tmp_path / 'm.png'}:lenses",
        "--region",
        f"{tmp_path / 'm.png'}:gradient:opacity=0.5",
    ]
    out = ["--frames", "1-1", "--progress", "none"]
    made = ["--track", str(tmp_path / "t.mtrk"), *QUICK]
    assert main(["animate", str(clip), "-o", str(tmp_path / "a.png"), *out, *look, *made]) == 0
    command = ["render", str(tmp_path / "t.mtrk"), "-o", str(tmp_path / "b.png"), *out, *look]
    assert main(command) == 0
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.parametrize(
    ("spec", "code", "named"),
    [
        ("{mask}", 2, ", ".join(STYLES)),
        ("{mask}:sparkle", 2, "sparkle"),
        ("{mask}:edges:width=99", 2, "between 0.1 and 50"),
        ("no_such.png:flat", 3, "no_such.png"),
        ("{small}:flat", 3, "40x30"),
        ("{few}:flat", 3, "frame 2"),
    ],
)
def test_mistakes_are_one_line(
    spec: str, code: int, named: str, track: Path, tmp_path: Path, capsys
) -> None:
    """What is wrong and what may be written instead; nothing is left behind."""
    write_png(tmp_path / "mask.png", half(slice(0, 9)))
    write_png(tmp_path / "small.png", np.zeros((30, 40, 3), np.uint8))
    for number in range(2):
        write_png(tmp_path / f"few_{number}.png", half(slice(0, 9)))
    names = {"mask": "mask.png", "small": "small.png", "few": "few_%01d.png"}
    text = spec.format(**{key: tmp_path / name for key, name in names.items()})
    out = tmp_path / "out.mp4"
    command = ["render", str(track), "-o", str(out), "--region", text, "--progress", "none"]
    assert main(command) == code
    line = capsys.readouterr().err
    assert named in line
    assert line.count("\n") == 1
    assert not out.exists()
