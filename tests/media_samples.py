"""Small media files, made with PyAV, that have what tests of reading and writing need."""

import struct
import zlib
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from av.video.reformatter import Interpolation

from stages.media.sound.channels import channels_of

FLAGS = int(Interpolation.BICUBIC | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT)
MILLISECOND = Fraction(1, 1000)
STEADY_X264 = {"x264-params": "mbtree=0"}
"""With its macroblock tree x264 gives small clips other bits in one of ten to twenty runs."""
CHART = np.array(
    [
        *([r, g, b] for r in (0, 90, 255) for g in (0, 90, 255) for b in (0, 90, 255)),
        *([v, v, v] for v in (16, 64, 128, 235)),
        [200, 120, 90],
    ],
    dtype=np.uint8,
)
"""Colours of a test chart, [32, 3]."""


def picture(width: int, height: int, number: int = 0) -> np.ndarray:
    """A picture with a gradient and a moving bright square, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width]
    pixels = np.stack([x * 200 // width, y * 200 // height, np.full_like(x, 60)], axis=2)
    side = max(1, min(width, height) // 4)
    left = number * 3 % max(1, width - side)
    pixels[side : 2 * side, left : left + side] = (250, 240, 30)
    return pixels.astype(np.uint8)


def chart(width: int, height: int) -> np.ndarray:
    """The colours of CHART as 8 x 4 patches, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width]
    return CHART[y * 4 // height * 8 + x * 8 // width]


def patch_colors(pixels: np.ndarray) -> np.ndarray:
    """Colours at the middle of the patches of `chart`, [32, 3] int."""
    height, width = pixels.shape[:2]
    rows = (np.arange(4) * 2 + 1) * height // 8
    columns = (np.arange(8) * 2 + 1) * width // 16
    return pixels[np.ix_(rows, columns)].reshape(-1, 3).astype(int)


def write_video(
    path: Path,
    pictures: list[np.ndarray],
    *,
    pts: list[int] | None = None,
    time_base: Fraction = Fraction(1, 12800),
    codec: str = "libx264",
    pixel_format: str = "yuv420p",
    matrix: str | None = None,
    rotation: int = 0,
    way: tuple[int, int, int, int] | None = None,
    aspect: Fraction | None = None,
    options: dict[str, str] | None = None,
    sound: int = 0,
    sound_start: Fraction = Fraction(0),
    audio_codec: str = "aac",
) -> Path:
    """Write pictures as a video, one every 1/25 s unless `pts` says otherwise.

    `matrix` tags the colours (`bt709` or `bt601`); without it they are stored as BT.601 and
    left untagged. `way` says that a stored point (x, y) is shown at (a x + c y, b x + d y).
    `sound` is the number of seconds of a rising tone.
    """
    times = pts or [round(Fraction(n, 25) / time_base) for n in range(len(pictures))]
    muxer = {"video_track_timescale": str(time_base.denominator)}
    steady = STEADY_X264 if codec == "libx264" else {}
    with av.open(str(path), "w", container_options=muxer) as output:
        stream = output.add_stream(codec, rate=25, options={**steady, **(options or {})})
        stream.height, stream.width = pictures[0].shape[:2]
        stream.pix_fmt = pixel_format
        stream.codec_context.time_base = time_base
        stream.codec_context.thread_count = 1  # bits of x264 differ with the number of threads
        if aspect is not None:
            stream.codec_context.sample_aspect_ratio = aspect
        if matrix is not None:
            stream.codec_context.colorspace = {"bt709": 1, "bt601": 6}[matrix]
            stream.codec_context.color_range = 1
        if rotation:
            stream.set_display_rotation(rotation)
        if way is not None:
            a, b, c, d = (value * 2**16 for value in way)
            stream.set_display_matrix((a, b, 0, c, d, 0, 0, 0, 2**30))
        audio = output.add_stream(audio_codec, rate=48000) if sound else None
        for pixels, time in zip(pictures, times, strict=True):
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24").reformat(
                format=pixel_format,
                dst_colorspace="ITU709" if matrix == "bt709" else "ITU601",
                src_color_range="JPEG",
                dst_color_range="MPEG",
                interpolation=FLAGS,
            )
            frame.pts, frame.time_base = time, time_base
            output.mux(stream.encode(frame))
        output.mux(stream.encode(None))
        if audio is not None:
            _write_tone(output, audio, sound, sound_start)
    return path


def trim(path: Path, start: Fraction, seconds: Fraction) -> Path:
    """Let an mp4 show a part of itself only, by its edit lists, as editors on phones do."""
    content = bytearray(path.read_bytes())
    (movie,) = struct.unpack_from(">I", content, content.index(b"mvhd") + 16)
    place = 0
    while (place := content.find(b"elst", place)) >= 0:
        (track,) = struct.unpack_from(">I", content, content.index(b"mdhd", place) + 16)
        first = struct.unpack_from(">i", content, place + 16)[0] + round(start * track)
        struct.pack_into(">Ii", content, place + 12, round(seconds * movie), first)
        place += 4
    path.write_bytes(content)
    return path


def _write_tone(output, audio, seconds: int, start: Fraction) -> None:
    """A rising stereo tone."""
    t = np.arange(seconds * 48000) / 48000
    wave = (0.3 * np.sin(2 * np.pi * (300 + 200 * t) * t)).astype(np.float32)
    for first in range(0, len(wave), 960):
        block = np.repeat(wave[None, first : first + 960], 2, axis=0)
        frame = av.AudioFrame.from_ndarray(np.ascontiguousarray(block), "fltp", "stereo")
        frame.sample_rate = 48000
        frame.pts, frame.time_base = first + round(start * 48000), Fraction(1, 48000)
        output.mux(audio.encode(frame))
    output.mux(audio.encode(None))


def write_sound(path: Path, seconds: int = 1) -> Path:
    """A file without any picture."""
    with av.open(str(path), "w") as output:
        _write_tone(output, output.add_stream("aac", rate=48000), seconds, Fraction(0))
    return path


def add_tones(
    video: Path, path: Path, layout: str, codec: str = "pcm_s16le", rate: int = 48000
) -> Path:
    """Put half a second of sound beside a video's pictures: channel n hums at 30 (n + 1) Hz."""
    count = av.AudioLayout(layout).nb_channels
    t = np.arange(rate // 2) / rate
    waves = 0.1 * np.sin(2 * np.pi * 30 * np.arange(1, count + 1)[:, None] * t)
    samples = np.ascontiguousarray((waves * 32767).astype(np.int16).T).reshape(1, -1)
    with av.open(str(video)) as source, av.open(str(path), "w") as output:
        shown = output.add_stream_from_template(source.streams.video[0])
        sound = output.add_stream(codec, rate=rate)
        sound.codec_context.layout = layout
        for packet in source.demux(video=0):
            if packet.size:
                packet.stream = shown
                output.mux(packet)
        for first in range(0, rate // 2, 960):
            block = samples[:, first * count : (first + 960) * count]
            frame = av.AudioFrame.from_ndarray(block, "s16", layout)
            frame.sample_rate, frame.pts, frame.time_base = rate, first, Fraction(1, rate)
            output.mux(sound.encode(frame))
        output.mux(sound.encode(None))
    return path


def set_order(path: Path, tag: int) -> Path:
    """Change the order of channels that a mov file states to one of Apple's numbered ones."""
    content = path.read_bytes()
    place = content.index(b"chan") + 8
    path.write_bytes(content[:place] + struct.pack(">II", tag, 0) + content[place + 8 :])
    return path


def loudest_tones(path: Path) -> dict[str, int]:
    """Which tone of `add_tones` is the loudest in every channel, by its name."""
    blocks: list[np.ndarray] = []
    names: tuple[str, ...] = ()
    packed = av.AudioResampler("flt")  # PyAV reads past the end of eight planes
    with av.open(str(path)) as source:
        for packet in source.demux(audio=0):
            for frame in packet.decode():
                channels_of(frame)  # else PyAV frees a custom order twice
                for made in packed.resample(frame):
                    channels_of(made)
                    names = tuple(channel.name for channel in made.layout.channels)
                    blocks.append(made.to_ndarray().reshape(-1, len(names)).T)
                    rate = made.sample_rate
    wave = np.concatenate(blocks, axis=1)[:, 2000:-2000]
    heard = np.abs(np.fft.rfft(wave * np.hanning(wave.shape[1])))
    peaks = np.argmax(heard, axis=1) * rate / wave.shape[1]
    return {name: round(peak / 30) - 1 for name, peak in zip(names, peaks, strict=True)}


def sound_packets(path: Path) -> list[tuple[Fraction, bytes]]:
    """Time [s] and content of every audio packet of a file."""
    with av.open(str(path)) as source:
        return [
            (packet.pts * packet.time_base, bytes(packet))
            for packet in source.demux(audio=0)
            if packet.size
        ]


def png_header_only(path: Path, width: int, height: int) -> Path:
    """A PNG that claims a size and holds next to no pixels."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = (
        chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0" * 1000)) + chunk(b"IEND", b"")
    )
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)
    return path


def write_still(path: Path, pixels: np.ndarray, layout: str = "rgb24") -> Path:
    """Write pixels of any of FFmpeg's layouts as a PNG."""
    context = av.CodecContext.create("png", "w")
    context.height, context.width = pixels.shape[:2]
    context.pix_fmt = layout.replace("le", "be") if layout.endswith("le") else layout
    context.time_base = Fraction(1, 25)
    frame = av.VideoFrame.from_ndarray(pixels, format=layout).reformat(format=context.pix_fmt)
    frame.pts = 0
    packets = [*context.encode(frame), *context.encode(None)]
    path.write_bytes(b"".join(bytes(packet) for packet in packets))
    return path
