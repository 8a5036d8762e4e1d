"""From a stack that leaves holes to a file with transparency; looks that show the source."""

from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from pipeline.cli import main
from tests.tracks import write_clip

QUICK = ("--iterations", "2", "--frame-iterations", "2", "--triangles", "40", "--progress", "none")
HOLES = ("--style", "shrink:gap=6,rounding=0")


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a short clip."""
    return write_clip(tmp_path_factory.mktemp("see_through") / "in.mp4")


@pytest.fixture(scope="module")
def track(clip: Path) -> Path:
    """Give its mesh track."""
    target = clip.with_suffix(".mtrk")
    assert main(["solve", str(clip), "-o", str(target), "--frames", "0-3", *QUICK]) == 0
    return target


@pytest.mark.parametrize(
    ("name", "flags", "holds_alpha"),
    [
        ("out.mov", ("--codec", "prores"), True),
        ("out.webm", (), True),
        ("out.mkv", ("--codec", "ffv1"), True),
        ("out.mp4", (), False),
    ],
)
def test_videos_keep_transparency(
    name: str, flags: tuple, holds_alpha: bool, track: Path, tmp_path: Path
) -> None:
    """Where the format holds it; else the holes are white paper."""
    target = tmp_path / name
    assert (
        main(["render", str(track), "-o", str(target), *flags, *HOLES, "--progress", "none"]) == 0
    )
    decoder = "libvpx-vp9" if name.endswith("webm") else None
    with av.open(str(target)) as container:
        stream = container.streams.video[0]
        context = av.CodecContext.create(decoder, "r") if decoder else stream.codec_context
        packets = list(container.demux(stream))
        frames = [frame for packet in packets for frame in context.decode(packet)]
    assert len(frames) == 4
    assert any(part.is_alpha for part in frames[0].format.components) == holds_alpha
    if not holds_alpha:
        assert frames[0].to_ndarray(format="rgb24").max() > 245
        return
    alpha = frames[0].reformat(format="rgba").to_ndarray()[..., 3]
    assert alpha.min() < 30
    assert alpha.max() > 225


def test_stills_keep_transparency(track: Path, tmp_path: Path) -> None:
    """PNG has four channels where a stack leaves holes, and three where it does not."""
    for style, channels in ((HOLES, 4), (("--style", "flat"), 3)):
        out = tmp_path / f"{channels}_%01d.png"
        command = ["render", str(track), "-o", str(out), "--frames", "1", "--progress", "none"]
        assert main([*command, *style]) == 0
        pixels = cv2.imread(str(tmp_path / f"{channels}_1.png"), cv2.IMREAD_UNCHANGED)
        assert pixels.shape[2] == channels
    assert main([*command[:3], str(tmp_path / "x.png"), *command[4:], *HOLES]) == 0
    assert cv2.imread(str(tmp_path / "x.png"), cv2.IMREAD_UNCHANGED)[..., 3].min() == 0


def test_source_is_found_again(clip: Path, track: Path, tmp_path: Path, capsys) -> None:
    """Beside the track or by --source; each frame has its own; without it one line says so."""
    render = ["render", str(track), "--style", "source", "--progress", "none", "--frames", "1-2"]
    assert main([*render, "-o", str(tmp_path / "a_%01d.png")]) == 0
    with av.open(str(clip)) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    for number in (1, 2):
        pixels = cv2.imread(str(tmp_path / f"a_{number}.png"))[..., ::-1].astype(int)
        assert np.abs(pixels - frames[number]).mean() < 3
    moved = clip.rename(tmp_path / "moved.mp4")
    try:
        assert main([*render, "-o", str(tmp_path / "b_%01d.png")]) == 3
        assert "--source" in capsys.readouterr().err
        assert main([*render, "-o", str(tmp_path / "b_%01d.png"), "--source", str(moved)]) == 0
    finally:
        moved.rename(clip)
    assert (tmp_path / "a_1.png").read_bytes() == (tmp_path / "b_1.png").read_bytes()


def test_resumed_clip_shows_its_source(clip: Path, tmp_path: Path) -> None:
    """What the track holds already is drawn over the frames that belong to it."""
    track = tmp_path / "t.mtrk"
    look = ["--style", "lenses", *QUICK, "--track", str(track)]
    assert (
        main(["animate", str(clip), "-o", str(tmp_path / "a_%01d.png"), "--frames", "0-1", *look])
        == 0
    )
    more = ["--frames", "0-3", "--resume"]
    assert main(["animate", str(clip), "-o", str(tmp_path / "b_%01d.png"), *look, *more]) == 0
    for number in (0, 1):
        pair = [(tmp_path / f"{name}_{number}.png").read_bytes() for name in "ab"]
        assert pair[0] == pair[1]
