"""Colours on their way through files, within one code value."""

from pathlib import Path

import av
import media_samples as samples
import numpy as np
import pytest
from av.video.frame import VideoFrame
from av.video.reformatter import VideoReformatter

from stages.media import EncodeOptions, open_decoder, open_encoder, probe
from stages.media.color.hdr import tone_map
from stages.media.color.yuv import FLAGS, RgbReader, YuvWriter, read_color

SD, HD = (320, 160), (1280, 320)


def chart_through(path: Path) -> np.ndarray:
    """Colours of the chart's patches as they are decoded."""
    with open_decoder(path) as decoder:
        return samples.patch_colors(next(decoder).pixels)


@pytest.mark.parametrize("pixel_format", ["yuv420p", "yuv444p"])
@pytest.mark.parametrize(
    ("size", "matrix"), [(SD, "bt709"), (HD, "bt709"), (SD, "bt601"), (HD, "bt601")]
)
def test_tagged_video(
    tmp_path: Path, size: tuple[int, int], matrix: str, pixel_format: str
) -> None:
    """A tagged chart is decoded by its tag, whatever its size."""
    path = samples.write_video(
        tmp_path / "a.mkv",
        [samples.chart(*size)],
        codec="ffv1",
        matrix=matrix,
        pixel_format=pixel_format,
    )
    assert probe(path).color_matrix == matrix
    assert np.abs(chart_through(path) - samples.CHART).max() <= 1


def test_untagged_small_video_is_bt601(tmp_path: Path) -> None:
    """Players take BT.601 for small pictures."""
    path = samples.write_video(tmp_path / "a.mkv", [samples.chart(*SD)], codec="ffv1")
    assert np.abs(chart_through(path) - samples.CHART).max() <= 1
    assert probe(path).color_matrix == "bt601"


@pytest.mark.parametrize(
    ("size", "told"), [((640, 360), 0), ((406, 720), 1), ((1280, 544), 1), ((1280, 720), 0)]
)
def test_untagged_colour_is_told_where_players_disagree(
    tmp_path: Path, size: tuple[int, int], told: int
) -> None:
    """Once, and not where every player takes the same matrix."""
    path = samples.write_video(tmp_path / "a.mkv", [samples.picture(*size)], codec="ffv1")
    assert sum("untagged" in note for note in probe(path).notes) == told


def test_untagged_large_video_is_bt709(tmp_path: Path) -> None:
    """Players take BT.709 for large pictures."""
    path = samples.write_video(tmp_path / "a.mkv", [samples.chart(*HD)], codec="ffv1")
    with av.open(str(path)) as source:
        frame = next(source.decode(video=0))
        expected = frame.reformat(
            format="rgb24",
            src_colorspace="ITU709",
            src_color_range="MPEG",
            dst_color_range="JPEG",
            interpolation=samples.FLAGS,
        ).to_ndarray()
    assert np.abs(chart_through(path) - samples.patch_colors(expected)).max() == 0
    assert np.abs(chart_through(path) - samples.CHART).max() > 10  # the chart was stored as 601


@pytest.mark.parametrize("ending", ["mp4", "mkv", "webm"])
@pytest.mark.parametrize("size", [SD, HD])
def test_plain_colours_survive_encoding(tmp_path: Path, size: tuple[int, int], ending: str) -> None:
    """A picture of one colour comes back within one code value after encode and decode."""
    source = samples.write_video(tmp_path / "in.mp4", [samples.picture(*size)])
    info = probe(source)
    target = tmp_path / f"out.{ending}"
    options = EncodeOptions(audio=False, crf=1)
    colors = samples.CHART[[0, 4, 13, 20, 26, 27, 29, 31]]
    with open_encoder(target, info, size, options) as encoder:
        for number, color in enumerate(colors):
            pixels = np.broadcast_to(color, (size[1], size[0], 3))
            encoder.write(pixels, number * 40, samples.MILLISECOND)
    with open_decoder(target) as decoder:
        found = [frame.pixels[size[1] // 2, size[0] // 2].astype(int) for frame in decoder]
    assert np.abs(np.array(found) - colors).max() <= 1


@pytest.mark.parametrize("transfer", ["pq", "hlg"])
def test_tone_mapping_is_sane(transfer: str) -> None:
    """Black stays black, grays stay gray and rise, bright light ends in white."""
    codes = np.linspace(0, 65535, 256).astype(np.uint16)
    mapped = tone_map(np.repeat(codes[None, :, None], 3, axis=2), transfer)[0].astype(int)
    assert mapped[0].tolist() == [0, 0, 0]
    assert mapped[-1].min() >= 250
    assert np.ptp(mapped, axis=1).max() <= 1
    assert (np.diff(mapped[:, 1]) >= 0).all()


def test_diffuse_white_of_pq_is_bright() -> None:
    """203 cd/m2, code 0.58, is below full white but not gray."""
    white = np.full((1, 1, 3), round(0.5807 * 65535), np.uint16)
    assert 190 <= tone_map(white, "pq")[0, 0, 0] <= 245


def test_pq_video_is_mapped_and_noted(tmp_path: Path) -> None:
    """An HDR label is obeyed and told."""
    path = tmp_path / "hdr.mkv"
    with av.open(str(path), "w") as output:
        stream = output.add_stream("ffv1", rate=25)
        stream.width, stream.height, stream.pix_fmt = 64, 32, "yuv420p10le"
        stream.codec_context.colorspace = 9
        stream.codec_context.color_primaries = 9
        stream.codec_context.color_trc = 16
        stream.codec_context.color_range = 1
        gray = np.full((32, 64, 3), 148, np.uint8)
        frame = av.VideoFrame.from_ndarray(gray).reformat(
            format="yuv420p10le", dst_colorspace="BT2020", dst_color_range="MPEG"
        )
        frame.pts = 0
        output.mux([*stream.encode(frame), *stream.encode(None)])
    info = probe(path)
    assert info.hdr == "pq"
    assert any("PQ" in note for note in info.notes)
    with open_decoder(path) as decoder:
        pixel = next(decoder).pixels[16, 32].astype(int)
    assert pixel.min() > 170
    assert np.ptp(pixel) <= 2


@pytest.mark.parametrize("stored", ["yuv420p", "yuv422p10le", "yuvj444p", "nv12", "gray"])
@pytest.mark.parametrize("size", [(64, 48), (34, 18)])
def test_planes_have_the_values_of_packed_pixels(stored: str, size: tuple[int, int]) -> None:
    """What goes through planes because that is faster is equal to the bit, both ways."""
    width, height = size
    rng = np.random.default_rng(width)
    packed = VideoFrame.from_ndarray(rng.integers(0, 256, (height, width, 3), np.uint8), "rgb24")
    frame = VideoReformatter().reformat(packed, format=stored)
    color = read_color(frame)
    read = RgbReader().read8(frame, color, size)
    ranges = {"src_color_range": 2 if color.full_range else 1, "dst_color_range": 2}
    if stored != "gray":  # whose range is stretched afterwards
        expected = VideoReformatter().reformat(
            frame, format="rgb24", src_colorspace=color.colorspace, interpolation=FLAGS, **ranges
        )
        assert np.array_equal(read, expected.to_ndarray())
    if stored not in ("nv12", "gray"):
        is_jpeg = stored.startswith("yuvj")
        direct = VideoReformatter().reformat(
            VideoFrame.from_ndarray(read, "rgb24"),
            format=stored,
            dst_colorspace=5 if is_jpeg else 1,
            src_color_range=2,
            dst_color_range=2 if is_jpeg else 1,
            interpolation=FLAGS,
        )
        writer = YuvWriter(stored)
        for _ in range(2):  # the second time in the same memory
            assert np.array_equal(writer.write(read).to_ndarray(), direct.to_ndarray())
