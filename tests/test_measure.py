"""`trimotion measure`: known pictures have known errors; what does not match is refused."""

import json
import math
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.compare.measure import measure
from pipeline.compare.resample import resample
from stages.media import FrameRange
from warp_kernels.errors import MediaError, TrimotionError

WHOLE = FrameRange()


def write_still(path: Path, pixels: np.ndarray) -> Path:
    """Write a picture without loss."""
    assert cv2.imwrite(str(path), pixels[..., ::-1])
    return path


def write_clip(path: Path, pictures: list[np.ndarray], times: list[int] | None = None) -> Path:
    """Write a video without loss; times in 1/25 s."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=25)
        stream.height, stream.width = pictures[0].shape[:2]
        stream.pix_fmt = "bgr0"
        stream.codec_context.time_base = Fraction(1, 25)
        for number, pixels in enumerate(pictures):
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
            frame.pts = number if times is None else times[number]
            frame.time_base = Fraction(1, 25)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def gray(value: int, width: int = 16, height: int = 12) -> np.ndarray:
    """A picture of one grey."""
    return np.full((height, width, 3), value, np.uint8)


def test_known_error_of_a_still(tmp_path: Path) -> None:
    """A difference of 4 everywhere, then of 4 in one channel: by hand."""
    source = write_still(tmp_path / "a.png", gray(100))
    report = measure(source, write_still(tmp_path / "b.png", gray(104)), WHOLE)
    assert report.rmse == pytest.approx(4.0)
    assert report.residual == pytest.approx(4.0 * math.sqrt(1.5))
    assert report.psnr == pytest.approx(20 * math.log10(255 / 4))
    one_channel = gray(100)
    one_channel[..., 1] += 4
    report = measure(source, write_still(tmp_path / "c.png", one_channel), WHOLE)
    assert report.rmse == pytest.approx(4.0 / math.sqrt(3))
    # Eq. 12 with E = 1/2 of the squared error summed over the channels: sqrt(16 / 2).
    assert report.residual == pytest.approx(math.sqrt(8.0))


def test_clip_has_mean_and_worst(tmp_path: Path) -> None:
    """The mean of the frames' errors, and the frame with the largest."""
    source = write_clip(tmp_path / "a.mkv", [gray(50)] * 4)
    output = write_clip(tmp_path / "b.mkv", [gray(50), gray(52), gray(60), gray(54)])
    report = measure(source, output, WHOLE)
    assert [frame.rmse for frame in report.frames] == pytest.approx([0.0, 2.0, 10.0, 4.0])
    assert report.rmse == pytest.approx(4.0)
    assert (report.worst.frame, report.worst.rmse) == (2, pytest.approx(10.0))
    assert report.psnr == pytest.approx(10 * math.log10(255**2 / 30))
    assert math.isinf(report.frames[0].psnr)


def test_table_and_json(tmp_path: Path, capsys) -> None:
    """Both come from the command; an infinite ratio is null in JSON."""
    clip = str(write_clip(tmp_path / "a.mkv", [gray(50), gray(90)]))
    assert main(["measure", clip, clip]) == 0
    table = capsys.readouterr().out
    assert table.startswith("2 frames at 16x12\n")
    assert "0.000" in table
    assert "inf" in table
    assert main(["measure", clip, clip, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert (values["frames"], values["rmse"], values["psnr"], values["R"]) == (2, 0.0, None, 0.0)
    assert len(values["per_frame"]) == 2


def test_part_of_a_source(tmp_path: Path) -> None:
    """An output of some frames starts at time 0 and is compared with those."""
    source = write_clip(tmp_path / "a.mkv", [gray(10 * number) for number in range(8)])
    output = write_clip(tmp_path / "b.mkv", [gray(33), gray(43)])
    report = measure(source, output, FrameRange(3, 4))
    assert [frame.frame for frame in report.frames] == [3, 4]
    assert report.rmse == pytest.approx(3.0)


def test_output_of_another_size_is_scaled(tmp_path: Path) -> None:
    """One colour stays itself at any size, and the report says what was done."""
    source = write_still(tmp_path / "a.png", gray(100))
    for width, height in ((8, 6), (48, 36), (33, 25)):
        output = write_still(tmp_path / f"{width}.png", gray(107, width, height))
        report = measure(source, output, WHOLE)
        assert report.rmse == pytest.approx(7.0)
        assert report.notes == (f"the output is {width}x{height}: scaled to the source's size",)


def test_padding_to_even_sides_is_left_out(tmp_path: Path, rng: np.random.Generator) -> None:
    """An odd picture that was padded for the codec is compared pixel by pixel."""
    pixels = rng.integers(0, 256, (11, 15, 3), dtype=np.uint8)
    padded = np.pad(pixels, ((0, 1), (0, 1), (0, 0)), mode="edge")
    source = write_still(tmp_path / "a.png", pixels)
    report = measure(source, write_still(tmp_path / "b.png", padded), WHOLE)
    assert report.rmse == 0.0
    assert "padding" in report.notes[0]


def test_stills_are_matched_by_order(tmp_path: Path) -> None:
    """Numbered stills carry no times."""
    source = write_clip(tmp_path / "a.mkv", [gray(50)] * 3, [0, 3, 7])
    for number in range(3):
        write_still(tmp_path / f"s_{number}.png", gray(51))
    assert measure(source, tmp_path / "s_%01d.png", WHOLE).rmse == pytest.approx(1.0)


@pytest.mark.parametrize(("before", "after"), [(3, 5), (5, 3)])
def test_unequal_counts_are_refused(before: int, after: int, tmp_path: Path) -> None:
    """Both numbers are named."""
    source = write_clip(tmp_path / "a.mkv", [gray(50)] * before)
    output = write_clip(tmp_path / "b.mkv", [gray(50)] * after)
    with pytest.raises(TrimotionError, match=f"has {after} frames, .* has {before};"):
        measure(source, output, WHOLE)


def test_unequal_times_are_refused(tmp_path: Path) -> None:
    """The first frame that is shown at another time is named."""
    source = write_clip(tmp_path / "a.mkv", [gray(50)] * 3, [0, 1, 2])
    output = write_clip(tmp_path / "b.mkv", [gray(50)] * 3, [0, 2, 3])
    with pytest.raises(TrimotionError, match=r"frame 1 is shown at 0\.080 s, .* at 0\.040 s"):
        measure(source, output, WHOLE)


def test_another_shape_is_refused(tmp_path: Path, capsys) -> None:
    """Both sizes are named; exit code 1, one line."""
    source = write_still(tmp_path / "a.png", gray(50))
    output = write_still(tmp_path / "b.png", gray(50, 12, 16))
    assert main(["measure", str(source), str(output)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "12x16 has another shape" in captured.err
    assert captured.err.count("\n") == 1


def test_missing_file_is_refused(tmp_path: Path) -> None:
    """Either of the two."""
    source = write_still(tmp_path / "a.png", gray(50))
    for pair in ((source, tmp_path / "no.png"), (tmp_path / "no.png", source)):
        with pytest.raises(MediaError, match=r"no\.png"):
            measure(*pair, WHOLE)


def test_resample_keeps_ramps_and_means(rng: np.random.Generator) -> None:
    """A ramp stays a ramp away from the border; shrinking by whole numbers keeps the mean."""
    ramp = np.repeat(np.arange(0, 240, 10, dtype=np.uint8)[None, :, None], 6, 0).repeat(3, 2)
    wide = resample(ramp, (48, 12))
    assert wide.shape == (12, 48, 3)
    np.testing.assert_allclose(np.diff(wide[6, 2:-2, 0]), 5.0)
    noise = rng.integers(0, 256, (64, 64, 3), dtype=np.uint8)
    assert resample(noise, (16, 16)).mean() == pytest.approx(noise.mean(), rel=0.02)
    assert resample(noise, (64, 64)) is noise


def test_progress_is_told_apart_from_the_figures(tmp_path: Path, capsys) -> None:
    """Every frame is told of on standard error, where it does not disturb programs."""
    clip = str(write_clip(tmp_path / "a.mkv", [gray(50)] * 3))
    assert main(["measure", clip, clip, "--json"]) == 0
    told = capsys.readouterr()
    assert "frame 3/3" in told.err
    assert json.loads(told.out)["frames"] == 3
    assert main(["measure", clip, clip, "--quiet"]) == 0
    assert capsys.readouterr().err == ""
