"""Frames of a source: upright RGB with the file's own times."""

from fractions import Fraction
from pathlib import Path

import av
import media_samples as samples
import numpy as np
import pytest

from stages.frame import Frame
from stages.media import (
    EncodeOptions,
    FrameRange,
    count_frames,
    open_decoder,
    open_encoder,
    probe,
)
from warp_kernels.errors import MediaError, OptionError


def frames_of(path: Path, wanted: FrameRange | None = None) -> list[Frame]:
    """All frames of a source."""
    with open_decoder(path, wanted or FrameRange()) as decoder:
        return list(decoder)


def clip(count: int, width: int = 64, height: int = 48) -> list[np.ndarray]:
    """Pictures of a short clip."""
    return [samples.picture(width, height, n) for n in range(count)]


def test_uneven_times_survive(tmp_path: Path) -> None:
    """Frames of a variable frame rate keep their exact times, B-frames or not."""
    pts = [0, 33, 40, 41, 500, 501, 777, 10000, 10040]
    path = samples.write_video(
        tmp_path / "vfr.mp4", clip(9), pts=pts, time_base=samples.MILLISECOND
    )
    frames = frames_of(path)
    assert [f.pts for f in frames] == pts
    assert frames[0].time_base == samples.MILLISECOND
    assert [f.index for f in frames] == list(range(9))


def test_info_tells_what_the_file_is(tmp_path: Path) -> None:
    """Probing reads size, rate, count, sound and the guess on colours."""
    path = samples.write_video(
        tmp_path / "a.mp4", clip(10), sound=1, aspect=Fraction(4, 3), matrix="bt709"
    )
    info = probe(path)
    assert (info.width, info.height, info.frame_count) == (64, 48, 10)
    assert (info.kind, info.codec, info.audio_codec) == ("video", "h264", "aac")
    assert (info.average_rate, info.duration) == (25, Fraction(2, 5))
    assert (info.sample_aspect, info.color_matrix) == (Fraction(4, 3), "bt709")
    assert info.as_dict()["time_base"] == "1/12800"
    assert info.as_dict()["notes"] == []


@pytest.mark.parametrize("rotation", [90, 180, 270])
def test_rotation_is_baked_in(tmp_path: Path, rotation: int) -> None:
    """A display matrix turns the picture counter-clockwise, as players do."""
    pictures = [samples.chart(64, 32)]
    path = samples.write_video(
        tmp_path / "r.mp4",
        pictures,
        rotation=rotation,
        aspect=Fraction(2, 1),
        pixel_format="yuv444p",
        options={"crf": "1"},
    )
    expected = np.rot90(pictures[0], k=rotation // 90)
    with open_decoder(path) as decoder:
        frame = next(decoder)
        assert decoder.info.rotation == rotation
        assert decoder.info.sample_aspect == (Fraction(2) if rotation == 180 else Fraction(1, 2))
        assert (decoder.info.width, decoder.info.height) == (frame.width, frame.height)
    assert frame.pixels.shape == expected.shape
    assert frame.pixels.flags.c_contiguous
    assert np.abs(frame.pixels.astype(int) - expected).mean() < 6


@pytest.mark.parametrize("size", [(33, 17), (1, 1), (2, 90)])
def test_odd_sizes(tmp_path: Path, size: tuple[int, int]) -> None:
    """Any size can be read, and no row is padded."""
    path = samples.write_video(
        tmp_path / "odd.mkv", clip(2, *size), codec="ffv1", pixel_format="bgr0"
    )
    frame = frames_of(path)[0]
    assert (frame.width, frame.height) == size
    assert np.array_equal(frame.pixels, clip(1, *size)[0])


def test_range_by_number(tmp_path: Path) -> None:
    """A-BxS yields exactly those frames, with the same pixels and times as the whole clip."""
    path = samples.write_video(tmp_path / "a.mp4", clip(20))
    whole = frames_of(path)
    part = frames_of(path, FrameRange(3, 11, 4))
    assert [f.index for f in part] == [3, 7, 11]
    for frame in part:
        assert frame.pts == whole[frame.index].pts
        assert np.array_equal(frame.pixels, whole[frame.index].pixels)


def test_range_far_into_a_clip(tmp_path: Path) -> None:
    """Seeking lands on the same frame as decoding from the start."""
    path = samples.write_video(tmp_path / "long.mp4", clip(420), options={"g": "50"})
    whole = {f.index: f for f in frames_of(path) if f.index in (349, 350, 351)}
    for number, expected in whole.items():
        (frame,) = frames_of(path, FrameRange(number, number))
        assert (frame.index, frame.pts) == (number, expected.pts)
        assert np.array_equal(frame.pixels, expected.pixels)


def test_range_by_time(tmp_path: Path) -> None:
    """Times count from the first frame."""
    path = samples.write_video(tmp_path / "a.mp4", clip(25))
    part = frames_of(path, FrameRange.parse("0-", "0.4", "0.5"))
    assert [f.index for f in part] == [10, 11, 12]


def test_range_without_frames_is_an_error(tmp_path: Path) -> None:
    """A range behind the end names what there is."""
    path = samples.write_video(tmp_path / "a.mp4", clip(5))
    with pytest.raises(OptionError, match="frames 0 to 4"):
        frames_of(path, FrameRange(9, 12))


def test_cover_picture_is_not_the_video(tmp_path: Path) -> None:
    """The moving picture is read even if a cover picture is stored beside it."""
    plain = samples.write_video(tmp_path / "plain.mp4", clip(5))
    cover = samples.write_still(tmp_path / "c.png", samples.picture(200, 200))
    covered = tmp_path / "covered.mp4"
    with av.open(str(plain)) as a, av.open(str(cover)) as b, av.open(str(covered), "w") as out:
        picture = out.add_stream_from_template(b.streams.video[0], opaque=True)
        picture.disposition = av.stream.Disposition.attached_pic
        video = out.add_stream_from_template(a.streams.video[0], opaque=True)
        for source, target in ((b, picture), (a, video)):
            for packet in source.demux(video=0):
                if packet.size:
                    packet.stream = target
                    out.mux(packet)
    frames = frames_of(covered)
    assert len(frames) == 5
    assert frames[0].width == 64


def test_size_change_is_scaled_to_the_first(tmp_path: Path) -> None:
    """A stream that changes its size keeps one size and says so."""
    parts = []
    for number, size in enumerate(((64, 48), (32, 32))):
        path = samples.write_video(
            tmp_path / f"{number}.mpg",
            clip(5, *size),
            codec="mpeg2video",
            time_base=Fraction(1, 25),
        )
        with av.open(str(path)) as source:
            parts += [bytes(p) for p in source.demux(video=0) if p.size]
    joined = tmp_path / "joined.m2v"
    joined.write_bytes(b"".join(parts))
    with open_decoder(joined) as decoder:
        sizes = {(f.width, f.height) for f in decoder}
    assert sizes == {(64, 48)}
    assert any("size changes" in note for note in decoder.notes)


def test_interlaced_frames_are_woven(tmp_path: Path) -> None:
    """Every interlaced frame gives one picture without combs, at its own time."""
    x = np.arange(64)
    pictures = []
    for number in range(6):
        edges = np.where(np.arange(64) % 2, 12, 8) + 8 * number  # the second field is later
        white = x[None, :] < edges[:, None]
        pictures.append(np.repeat(white[..., None], 3, axis=2).astype(np.uint8) * 255)
    path = samples.write_video(
        tmp_path / "i.mkv",
        pictures,
        codec="mpeg2video",
        time_base=Fraction(1, 25),
        options={"flags": "+ildct+ilme", "field_order": "tt", "qmin": "1", "qmax": "2"},
    )
    with av.open(str(path)) as source:
        if not next(source.decode(video=0)).interlaced_frame:
            pytest.skip("this FFmpeg does not flag the frames")
    frames = frames_of(path)
    assert [f.pts for f in frames] == [0, 40, 80, 120, 160, 200]
    combs = [np.abs(np.diff(p[8:-8].astype(int), axis=0)).mean() for p in pictures]
    woven = [np.abs(np.diff(f.pixels[8:-8].astype(int), axis=0)).mean() for f in frames]
    assert woven[2] < combs[2] / 3


def test_sixteen_bit_gray_is_scaled(tmp_path: Path) -> None:
    """The whole range of 16 bits maps to the whole range of 8."""
    ramp = np.linspace(0, 65535, 64 * 16).reshape(16, 64).astype(np.uint16)
    path = samples.write_still(tmp_path / "g.png", ramp, "gray16le")
    (frame,) = frames_of(path)
    assert np.abs(frame.pixels[..., 1] - ramp / 257).max() <= 1.5


def test_transparency_is_shown_over_white(tmp_path: Path) -> None:
    """Hidden colours stay hidden, and a note says so."""
    pixels = np.zeros((8, 8, 4), np.uint8)
    pixels[:, :4] = (10, 20, 30, 255)
    path = samples.write_still(tmp_path / "a.png", pixels, "rgba")
    with open_decoder(path) as decoder:
        frame = next(decoder)
    assert frame.pixels[0, 0].tolist() == [10, 20, 30]
    assert frame.pixels[0, 7].tolist() == [255, 255, 255]
    assert any("transparent" in note for note in decoder.notes)


def test_still_is_a_video_of_one_frame(tmp_path: Path) -> None:
    """A picture comes unchanged, as frame 0 at time 0."""
    pixels = samples.picture(31, 17)
    path = samples.write_still(tmp_path / "a.png", pixels)
    (frame,) = frames_of(path)
    assert probe(path).kind == "image"
    assert (frame.index, frame.pts) == (0, 0)
    assert np.array_equal(frame.pixels, pixels)


def test_numbered_stills(tmp_path: Path) -> None:
    """Stills come in order and carry the number of their name."""
    for number in (1008, 1009, 1010, 1011):
        samples.write_still(tmp_path / f"s_{number}.png", samples.picture(16, 8, number))
    frames = frames_of(tmp_path / "s_####.png", FrameRange(1009))
    assert [f.index for f in frames] == [1009, 1010, 1011]
    assert [f.pts for f in frames] == [1, 2, 3]
    assert np.array_equal(frames[0].pixels, samples.picture(16, 8, 1009))


def test_missing_still_is_named(tmp_path: Path) -> None:
    """A gap is an error, unless the range leaves it out."""
    for number in (1, 2, 4):
        samples.write_still(tmp_path / f"s_{number:04d}.png", samples.picture(16, 8))
    with pytest.raises(MediaError, match=r"s_0003\.png: is missing"):
        frames_of(tmp_path / "s_%04d.png")
    assert len(frames_of(tmp_path / "s_%04d.png", FrameRange(0, 2))) == 2


@pytest.mark.parametrize("codec", ["libvpx", "libvpx-vp9"])
@pytest.mark.parametrize("ending", ["webm", "mkv"])
def test_transparent_vp8_and_vp9(tmp_path: Path, codec: str, ending: str) -> None:
    """FFmpeg's own decoders leave the transparency out: what is hidden would be shown."""
    path = tmp_path / f"a.{ending}"
    with av.open(str(path), "w") as output:
        stream = output.add_stream(codec, rate=25, options={"crf": "10", "b": "1M"})
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuva420p"
        stream.codec_context.options = {"auto-alt-ref": "0"}
        for number in range(5):
            pixels = np.zeros((48, 64, 4), np.uint8)
            pixels[:, :, 0] = 200
            pixels[:, 8 * number + 8 :, 3] = 255
            frame = av.VideoFrame.from_ndarray(pixels, format="rgba").reformat(format="yuva420p")
            frame.pts, frame.time_base = number, Fraction(1, 25)
            output.mux(stream.encode(frame))
        output.mux(stream.encode(None))
    with open_decoder(path) as decoder:
        frames = list(decoder)
    assert any("transparent" in note for note in decoder.notes)
    assert [frame.pts for frame in frames] == [0, 40, 80, 120, 160]
    for number, frame in enumerate(frames):
        edge = 8 * number + 8
        assert (frame.pixels[:, : edge - 4] > 240).all()
        assert (frame.pixels[:, edge + 4 :, 1:] < 30).all()


def test_our_own_transparent_webm_comes_back(tmp_path: Path) -> None:
    """What is written with transparency is read with it."""
    info = probe(samples.write_video(tmp_path / "in.mp4", clip(3)))
    path = tmp_path / "a.webm"
    pixels = np.dstack([samples.picture(64, 48), np.zeros((48, 64), np.uint8)])
    with open_encoder(path, info, (64, 48), EncodeOptions()) as encoder:
        for number in range(3):
            encoder.write(pixels, number, Fraction(1, 25))
    for frame in frames_of(path):
        assert (frame.pixels > 250).all()


@pytest.mark.parametrize(("start", "seconds"), [(5, 20), (13, 12), (20, 50), (0, 7)])
def test_trimmed_clips_have_what_a_player_shows(tmp_path: Path, start: int, seconds: int) -> None:
    """Edit lists hide frames that the file declares; nothing breaks off, and no count is wrong."""
    path = samples.write_video(tmp_path / "a.mp4", clip(50), options={"g": "10"})
    whole = frames_of(path)
    samples.trim(path, Fraction(start, 25), Fraction(seconds, 25))
    shown = min(seconds, 50 - start)
    with open_decoder(path) as decoder:
        frames = list(decoder)
        assert not decoder.warnings
    assert (probe(path).frame_count, count_frames(path), len(frames)) == (shown,) * 3
    assert np.array_equal(frames[-1].pixels, whole[start + shown - 1].pixels)


def test_a_frame_of_a_trimmed_clip_is_reached_by_its_number(tmp_path: Path) -> None:
    """Hidden frames do not count."""
    path = samples.write_video(tmp_path / "a.mp4", clip(420), options={"g": "50"})
    samples.trim(path, Fraction(30, 25), Fraction(380, 25))
    expected = next(frame for frame in frames_of(path) if frame.index == 345)
    (frame,) = frames_of(path, FrameRange(345, 345))
    assert (frame.index, frame.pts) == (345, expected.pts)
    assert np.array_equal(frame.pixels, expected.pixels)
