"""What a source is, learnt from its header and its first frame."""

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
from av.video.frame import VideoFrame

from stages.media.color.yuv import read_color
from stages.media.naming import NumberedPattern, input_pattern
from stages.media.orientation import sane_aspect
from stages.media.reading.info import MediaInfo
from stages.media.reading.read_options import AS_IT_COMES, ReadOptions
from stages.media.reading.sequence import existing_numbers, note_on_left_out
from stages.media.reading.source import VideoSource
from stages.media.sound.audio_plan import best_audio
from stages.media.sound.channels import channels_of
from warp_kernels.errors import OptionError

_CLOCK = re.compile(r"(\d+):(\d\d):(\d\d(?:\.\d+)?)")
_LEAST_BYTES = 8
"""A stored frame takes at least this much, its header included [bytes]."""

_BARE_STREAMS = frozenset(
    {"av1", "cavsvideo", "dirac", "h261", "h263", "h264", "hevc", "m4v", "mjpeg", "mpegvideo"}
    | {"obu", "vc1", "vvc"}
)
"""Formats without a container: FFmpeg guesses their duration from a bit rate, and badly."""


def probe(
    path: str | Path,
    *,
    max_pixels: int | None = None,
    read: ReadOptions = AS_IT_COMES,
) -> MediaInfo:
    """Look at a source without decoding more than its first frame.

    Args:
        path: A video, a still, or a pattern of numbered stills.
        max_pixels: Largest picture that is opened [px]; None for what was chosen.
        read: What the user chose.

    Raises:
        MediaError: If it cannot be read.
        OptionError: If a choice does not fit the source, or a pattern has several number fields.
    """
    pattern = input_pattern(path)
    if pattern is not None:
        return describe_sequence(pattern, existing_numbers(pattern), max_pixels, read)
    with VideoSource(Path(path), max_pixels, read=read) as source:
        return describe(source, read)


def describe(source: VideoSource, read: ReadOptions = AS_IT_COMES) -> MediaInfo:
    """Properties of an opened file.

    Args:
        source: The file; its first frame is decoded but not consumed.
        read: What the user chose.

    Raises:
        OptionError: If a frame rate is given for what has times.
        MediaError: If no frame can be decoded.
    """
    frame = source.first_frame()
    color = read_color(frame, source.profile_of(frame))
    shown = source.orientation_of(frame)
    notes = [*source.notes, *color.notes, *_notes_on(frame, color.hdr)]
    aspect = sane_aspect(source.stream.sample_aspect_ratio, shown)
    if aspect is None:
        notes.append(f"pixel aspect {source.stream.sample_aspect_ratio} ignored: taken as 1")
    sideways = shown.is_sideways
    picture = source.is_picture
    if read.fps is not None and not picture and source.format_name not in _BARE_STREAMS:
        raise OptionError(
            f"--fps {read.fps}: {source.path} has times of its own; leave the option out"
        )
    audio_codec, audio_channels, audio_rate = _audio(source)
    codec = source.stream.codec_context
    return MediaInfo(
        path=source.path,
        kind="image" if picture else "video",
        container=source.format_name,
        codec=codec.codec.canonical_name,
        pixel_format=frame.format.name,
        width=frame.height if sideways else frame.width,
        height=frame.width if sideways else frame.height,
        coded_width=frame.width,
        coded_height=frame.height,
        rotation=shown.rotation,
        sample_aspect=aspect or Fraction(1),
        time_base=source.time_base,
        average_rate=read.fps if picture else source.average_rate,
        frame_count=1 if picture else _frame_count(source),
        start_time=(frame.pts or 0) * source.time_base,
        duration=None if picture else _duration(source),
        color_matrix=color.matrix,
        color_range="full" if color.full_range else "limited",
        hdr=color.hdr,
        audio_codec=audio_codec,
        audio_channels=audio_channels,
        audio_rate=audio_rate,
        notes=tuple(notes),
        mirrored=shown.mirrored,
    )


def describe_sequence(
    pattern: NumberedPattern, numbers: list[int], max_pixels: int | None, read: ReadOptions
) -> MediaInfo:
    """Properties of numbered stills, by their first one.

    Args:
        pattern: Their name.
        numbers: The frame numbers that exist.
        max_pixels: Largest picture that is opened [px].
        read: What the user chose.

    Raises:
        MediaError: If the first still cannot be read.
    """
    with VideoSource(pattern.path_for(numbers[0]), max_pixels, read=read) as source:
        first = describe(source, read)
    rate = read.rate
    timeless = [f"numbered stills carry no times: {rate} frames a second taken, see --fps"]
    return replace(
        first,
        path=Path(pattern.text),
        kind="sequence",
        time_base=1 / rate,
        average_rate=rate,
        frame_count=len(numbers),
        first_frame=numbers[0],
        start_time=Fraction(0),
        duration=(numbers[-1] - numbers[0] + 1) / rate,
        notes=(
            *first.notes,
            *note_on_left_out(pattern),
            *(timeless if read.fps is None else ()),
        ),
    )


def _notes_on(frame: VideoFrame, hdr: str | None) -> list[str]:
    notes = []
    if hdr is not None:
        depth = max(component.bits for component in frame.format.components)
        doubt = "" if depth > 8 else f"; with only {depth} bits the label may be wrong"
        notes.append(f"labelled {hdr.upper()} (HDR): tone-mapped to BT.709{doubt}")
    if frame.interlaced_frame:
        notes.append("interlaced: one deinterlaced picture for every frame")
    return notes


def _audio(source: VideoSource) -> tuple[str | None, int | None, int | None]:
    """Codec, channels and samples per second of the sound."""
    stream = best_audio(source.container)
    if stream is None:
        return None, None, None
    context = stream.codec_context
    channels = channels_of(context).count
    return context.codec.canonical_name, channels, context.sample_rate or None


def _duration(source: VideoSource) -> Fraction | None:
    if source.container.format.name in _BARE_STREAMS:
        return None
    stream = source.stream
    if stream.duration and stream.duration > 0:
        return stream.duration * source.time_base
    tagged = _CLOCK.match(stream.metadata.get("DURATION", ""))
    if tagged:  # Matroska states where each track ends
        end = int(tagged[1]) * 3600 + int(tagged[2]) * 60 + Fraction(tagged[3])
        return max(Fraction(0), end - (stream.start_time or 0) * source.time_base) or None
    whole = source.container.duration
    return Fraction(whole, av.time_base) if whole and whole > 0 else None


def _frame_count(source: VideoSource) -> int | None:
    declared = source.declared_frames
    if declared:
        return declared
    duration, rate = _duration(source), source.average_rate
    if not duration or not rate:
        return None
    implied = max(1, round(duration * rate))
    # A jump of the clock would imply more frames than the file has room for.
    return implied if implied * _LEAST_BYTES <= source.path.stat().st_size else None
