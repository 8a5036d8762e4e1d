"""The sample videos: small, credited, and the drawn one shows what its script says."""

import re
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from av.video.reformatter import ColorRange

from pipeline.cli import main
from sample_videos import cut_to_song, make_shapes, make_song
from sample_videos.make_shapes import CUT_FRAME, FRAME_COUNT, shape_positions
from stages.hearing.listening.listen import listen

FOLDER = Path(make_shapes.__file__).parent
MEDIA = sorted(p for p in FOLDER.iterdir() if p.suffix in {".mp4", ".jpg", ".png", ".ogg"})
CENTER_TOLERANCE = 1.0
"""Largest distance [px] between a shape's centre and the centroid of its colour."""


@pytest.fixture(scope="module")
def shapes_clip() -> np.ndarray:
    """Decode shapes.mp4 to RGB, [frames, H, W, 3] float32."""
    with av.open(str(FOLDER / "shapes.mp4")) as container:
        frames = [
            frame.reformat(
                format="rgb24",
                dst_color_range=ColorRange.JPEG,
                interpolation=make_shapes.ACCURATE,
            ).to_ndarray()
            for frame in container.decode(video=0)
        ]
    return np.array(frames, dtype=np.float32)


def test_together_under_6_mb() -> None:
    """The folder stays small enough for a clone."""
    assert len(MEDIA) >= 4
    assert sum(path.stat().st_size for path in MEDIA) < 6e6


@pytest.mark.parametrize("path", MEDIA, ids=lambda path: path.name)
def test_file_is_credited(path: Path) -> None:
    """Each file has a row in the README, with origin, licence, credit and size filled in."""
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith(f"| `{path.name}` |")]
    assert len(rows) == 1
    cells = [cell.strip() for cell in rows[0].strip("|").split("|")]
    assert len(cells) == 7
    assert all(cells)
    stated = float(re.match(r"([\d.]+) MB", cells[5])[1])
    assert stated == pytest.approx(path.stat().st_size / 1e6, abs=0.006)


@pytest.mark.parametrize("path", [p for p in MEDIA if p.suffix == ".mp4"], ids=lambda p: p.name)
def test_clip_decodes_to_its_end(path: Path) -> None:
    """Every clip has about 3 s of frames at rising times."""
    with av.open(str(path)) as container:
        times = [frame.time for frame in container.decode(video=0)]
    assert 70 <= len(times) <= 100
    assert np.all(np.diff(times) > 0)


def test_shapes_have_the_drawn_colors(shapes_clip: np.ndarray) -> None:
    """The mean colour survives conversion, tags and decoding to a fifth of a level."""
    assert shapes_clip.shape == (FRAME_COUNT, make_shapes.HEIGHT, make_shapes.WIDTH, 3)
    for index in (0, CUT_FRAME - 1, CUT_FRAME, FRAME_COUNT - 1):
        difference = shapes_clip[index] - make_shapes.draw_frame(index)
        np.testing.assert_allclose(difference.mean(axis=(0, 1)), 0.0, atol=0.2)


def test_shapes_are_where_the_script_says(shapes_clip: np.ndarray) -> None:
    """The centroid of each unoccluded shape's colour lies within 1 px of its stated centre."""
    checked = 0
    for index in sorted({*range(0, FRAME_COUNT, 3), CUT_FRAME - 1, CUT_FRAME, FRAME_COUNT - 1}):
        pixels = shapes_clip[index]
        for name, shape in shape_positions(index).items():
            if not shape.occluded:
                distance = np.hypot(*np.subtract(_centroid(pixels, shape.color), shape.center))
                assert distance < CENTER_TOLERANCE, f"{name} in frame {index}"
                checked += 1
    assert checked > 50


def test_disc_disappears_behind_the_square(shapes_clip: np.ndarray) -> None:
    """In the middle of the first shot no pixel of the red disc is left, and it says so."""
    disc = shape_positions(24)["red disc"]
    assert disc.occluded
    assert np.abs(shapes_clip[24] - disc.color).max(axis=2).min() > 40


def test_cut_is_where_the_script_says(shapes_clip: np.ndarray) -> None:
    """The step before `CUT_FRAME` is larger than every other by far."""
    steps = np.abs(np.diff(shapes_clip[:, ::2, ::2], axis=0)).mean(axis=(1, 2, 3))
    assert int(np.argmax(steps)) + 1 == CUT_FRAME
    assert np.sort(steps)[-1] > 5 * np.sort(steps)[-2]


def test_beeps_start_each_second() -> None:
    """The sound is loud right after each full second and silent half a second later."""
    with av.open(str(FOLDER / "shapes.mp4")) as container:
        sound = np.concatenate([f.to_ndarray()[0] for f in container.decode(audio=0)])
    rate = make_shapes.SAMPLE_RATE
    for second in range(3):
        beep = sound[int((second + 0.02) * rate) : int((second + 0.1) * rate)]
        pause = sound[int((second + 0.4) * rate) : int((second + 0.6) * rate)]
        assert np.sqrt(np.mean(beep**2)) > 0.15
        assert np.abs(pause).max() < 0.005


def test_song_has_the_beats_that_the_script_says() -> None:
    """All of them are heard, near to where they were played, and so is the first of each bar."""
    heard = listen(FOLDER / "song.ogg").heard
    beats = np.arange(make_song.METER * make_song.BAR_COUNT) * make_song.BEAT
    np.testing.assert_allclose(heard.beats[: len(beats)], beats, atol=0.01)
    bars = beats[:: make_song.METER]
    np.testing.assert_allclose(heard.downbeats[: len(bars)], bars, atol=0.01)


def test_sections_of_the_show_begin_where_the_cut_does(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The timeline of the README fits its film, and its sections begin with its parts."""
    # real need: the script has one size, and its times do not depend on it
    monkeypatch.setattr(cut_to_song, "SIZE", (320, 180))
    film = tmp_path / "rough.mp4"
    cut_to_song.cut(film)
    words = ["timeline", str(FOLDER / "show.toml"), "--check", str(film)]
    assert main([*words, "--audio", str(FOLDER / "song.ogg")]) == 0
    table = capsys.readouterr().out.split("section\n")[1].split("\n\n")[0]
    begins = [int(line.split()[2]) for line in table.splitlines()]
    cuts = np.cumsum([0, *(end - first for _, first, end in cut_to_song.CUTS)])
    assert begins == list(cuts[:-1])


@pytest.mark.parametrize("frame", [-1, FRAME_COUNT])
def test_frame_outside_the_clip_is_refused(frame: int) -> None:
    """A frame number that the clip does not have is an error, not a position."""
    with pytest.raises(ValueError, match="is not in the clip"):
        shape_positions(frame)


def _centroid(pixels: np.ndarray, color: tuple[int, int, int]) -> tuple[float, float]:
    """Give the centroid [px] of the pixels near a colour, the nearer the heavier."""
    apart = cv2.absdiff(pixels, np.full_like(pixels, color)).max(axis=2)
    y, x = np.nonzero(apart < 50)
    weights = 1.0 - apart[y, x] / 50.0
    return float(np.average(x + 0.5, weights=weights)), float(np.average(y + 0.5, weights=weights))
