"""What will be written, decided and checked before any work is done."""

import io
import os
import re
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import av

from stages.media.expected_frames import expected_frames
from stages.media.frame_range import FrameRange
from stages.media.naming import SHAPES, STILL_ENDINGS, NumberedPattern
from stages.media.reading.info import MediaInfo
from stages.media.sound.audio_plan import AudioPlan, plan_audio, plan_song
from stages.media.writing.codecs import CONTAINERS, Container, VideoCodec, find_encoder
from stages.media.writing.encode_options import EncodeOptions
from stages.media.writing.encoder_setup import try_encoder
from stages.media.writing.place import check_folder, check_name
from warp_kernels.errors import OptionError, OutputError


@dataclass(frozen=True)
class OutputPlan:
    """A checked output."""

    path: Path
    """The file, or the pattern of the stills."""
    pattern: NumberedPattern | None
    """Pattern of numbered stills, or None."""
    container: Container | None
    """File format of a video or GIF; None for stills."""
    encoder: VideoCodec | None
    """Video encoder; None for stills."""
    pixel_format: str
    """Format that the encoder takes; empty for stills."""
    width: int
    """Width of the pictures that are handed over [px]."""
    height: int
    """Height of the pictures that are handed over [px]."""
    audio: AudioPlan | None
    """How the source's audio gets there; None without."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""

    @property
    def padded_width(self) -> int:
        """Width of the written picture [px]: even where the pixel format needs it."""
        return self.width + (self.width & 1 if self._pads(("yuv420", "yuv422")) else 0)

    @property
    def padded_height(self) -> int:
        """Height of the written picture [px]: even where the pixel format needs it."""
        return self.height + (self.height & 1 if self._pads(("yuv420",)) else 0)

    def _pads(self, halved: tuple[str, ...]) -> bool:
        if self.encoder is None or self.encoder.odd_sizes:
            return False
        return self.pixel_format.startswith(halved)


LOSSY = (".jpg", ".jpeg", ".webp")
"""Endings of stills that have a quality."""
WHOLE = FrameRange()
"""Every frame."""


def check_output(
    path: str | Path,
    source: MediaInfo,
    size: tuple[int, int],
    options: EncodeOptions,
    frame_range: FrameRange = WHOLE,
) -> OutputPlan:
    """Find out, before any work is done, whether an output can be written.

    Args:
        path: Output file, or a pattern of numbered stills; its ending chooses the format.
        source: What is converted.
        size: Width and height of the pictures that will be handed over [px].
        options: How to write.
        frame_range: The frames that are converted.

    Returns:
        What will be done; its notes tell the choices.

    Raises:
        OptionError: If the ending, the codec and the options do not go together.
        OutputError: If the file exists, is the input, or its folder cannot be written.
    """
    pattern = NumberedPattern.parse(path)
    target = Path(path)
    ending = pattern.ending if pattern else target.suffix.lower()
    if min(size) < 1:
        raise OptionError(f"size {size[0]}x{size[1]}: at least one pixel each way; choose a size")
    if ending in CONTAINERS and pattern is None:
        plan = _plan_video(target, ending, source, size, options)
    elif ending in STILL_ENDINGS or ending in SHAPES:
        plan = _plan_stills(target, pattern, source, size, options, frame_range)
    else:
        known = " ".join([*CONTAINERS, *sorted(STILL_ENDINGS), *SHAPES])
        if not ending:
            raise OptionError(
                f"output {path}: has no ending, which chooses the format; add one of {known}"
            )
        raise OptionError(
            f"output {path}: {'numbered ' if pattern else ''}files of ending {ending} cannot be "
            f"written; use {known}"
        )
    _check_place(plan, source, options, frame_range)
    return plan


def keeps_alpha(path: str | Path, options: EncodeOptions) -> bool:
    """Whether an output has room for transparency.

    Args:
        path: Output file, or a pattern of numbered stills.
        options: How to write.

    Raises:
        OptionError: If there is no such codec.
    """
    ending = Path(path).suffix.lower()
    if ending in CONTAINERS and NumberedPattern.parse(path) is None:
        encoder = find_encoder(options.codec or CONTAINERS[ending].codec)
        return encoder.alpha_format is not None and options.pixel_format is None
    return ending not in (".jpg", ".jpeg")


def _plan_video(
    target: Path, ending: str, source: MediaInfo, size: tuple[int, int], options: EncodeOptions
) -> OutputPlan:
    container = CONTAINERS[ending]
    encoder = find_encoder(options.codec or container.codec)
    _check_holds(container, encoder, ending)
    pixel_format = options.pixel_format or encoder.pixel_formats[0]
    if pixel_format not in encoder.pixel_formats:
        raise OptionError(
            f"pixel format {pixel_format!r}: {encoder.name} does not take it; "
            f"choose one of {', '.join(encoder.pixel_formats)}"
        )
    _check_quality(encoder, options)
    notes = []
    audio = None
    if options.audio and (options.song is not None or source.audio_codec is not None):
        if container.audio is None:
            notes.append(f"{ending} holds no sound: the audio is left out")
        elif options.song is not None:
            audio = plan_song(options.song, container)
            notes += audio.notes
        else:
            audio = plan_audio(source.path, container, options.audio_mode)
            notes += audio.notes if audio else []
    if container.format == "gif" and source.sample_aspect != 1:
        notes.append(f"{ending} has square pixels only: the picture will look stretched")
    if container.format in ("matroska", "webm"):
        if 1000 % source.time_base.denominator:
            notes.append(f"{ending} keeps times in whole milliseconds: they are rounded")
        if source.sample_aspect != 1 and encoder.name not in ("libx264", "libx265"):
            notes.append(
                f"{ending} with {encoder.name} loses the pixel aspect {source.sample_aspect}: "
                "the picture will look stretched"
            )
    plan = _note_padding(
        OutputPlan(
            target, None, container, encoder, pixel_format, size[0], size[1], audio, tuple(notes)
        )
    )
    try_encoder(encoder, pixel_format, (plan.padded_width, plan.padded_height), options)
    return plan


def _note_padding(plan: OutputPlan) -> OutputPlan:
    if (plan.padded_width, plan.padded_height) == (plan.width, plan.height):
        return plan
    note = (
        f"{plan.width}x{plan.height} is odd and {plan.pixel_format} needs even sizes: "
        f"border pixels repeated to {plan.padded_width}x{plan.padded_height}"
    )
    return replace(plan, notes=(*plan.notes, note))


def _plan_stills(
    target: Path,
    pattern: NumberedPattern | None,
    source: MediaInfo,
    size: tuple[int, int],
    options: EncodeOptions,
    frame_range: FrameRange,
) -> OutputPlan:
    count = expected_frames(frame_range, source)
    holds_clip = SHAPES.get(target.suffix.lower(), False)
    if pattern is None and count != 1 and not frame_range.is_single and not holds_clip:
        stem, ending = _NO_FIELD.sub("", target.stem) or "frame", target.suffix
        raise OptionError(
            f"output {target}: one still cannot hold {count or 'many'} frames; "
            f"write {stem}_####{ending}, or choose one frame with --frames N"
        )
    choices = (("codec", options.codec), ("pixel format", options.pixel_format))
    given = [f"{name} {value}" for name, value in choices if value is not None]
    if given:
        raise OptionError(f"{' and '.join(given)}: stills have none to choose; leave it out")
    if options.encoder_preset is not None:
        raise OptionError(
            f"encoder preset {options.encoder_preset}: {target.suffix} has none; leave it out"
        )
    if options.crf is not None and target.suffix.lower() not in LOSSY:
        raise OptionError(
            f"crf {options.crf}: {target.suffix} loses nothing and has no quality; leave it out"
        )
    if options.crf is not None and not 0 <= options.crf <= 51:
        raise OptionError(f"crf {options.crf}: choose a value from 0 to 51")
    has_sound = source.audio_codec is not None or options.song is not None
    holders = "stills" if target.suffix.lower() in STILL_ENDINGS else target.suffix.lower()
    verb = "hold" if holders == "stills" else "holds"
    notes = [f"{holders} {verb} no sound: the audio is left out"] if has_sound else []
    if not options.audio:
        notes = []
    return OutputPlan(target, pattern, None, None, "", size[0], size[1], None, tuple(notes))


_NO_FIELD = re.compile(r"[_-]?(#|%\d?d)$")
"""What was meant for a number field at the end of a name, and is none."""


def _check_holds(container: Container, encoder: VideoCodec, ending: str) -> None:
    trial = av.open(io.BytesIO(), "w", format=container.format)
    try:
        trial.add_stream(encoder.name, rate=25)
    except ValueError as error:
        raise OptionError(
            f"codec {encoder.name}: {ending} cannot hold it; use {encoder.usual} or another codec"
        ) from error
    finally:
        trial.close()


def _check_quality(encoder: VideoCodec, options: EncodeOptions) -> None:
    if options.crf is not None:
        if encoder.quality is None:
            raise OptionError(
                f"crf {options.crf}: {encoder.name} has no constant quality; leave it out"
            )
        if not encoder.best_quality <= options.crf <= encoder.worst_quality:
            raise OptionError(
                f"crf {options.crf}: {encoder.name} takes {encoder.best_quality} to "
                f"{encoder.worst_quality}, the best first; try {encoder.quality}"
            )
    if options.encoder_preset is not None and options.encoder_preset not in encoder.presets:
        raise OptionError(
            f"encoder preset {options.encoder_preset!r}: {encoder.name} takes "
            f"{', '.join(encoder.presets) or 'none; leave it out'}"
        )


def _check_place(
    plan: OutputPlan, source: MediaInfo, options: EncodeOptions, frame_range: FrameRange
) -> None:
    check_name(plan.path)
    existing = _existing(plan, frame_range)
    song = None if options.song is None else options.song.resolve()
    if _is_source(plan, existing, source) or any(one.resolve() == song for one in existing):
        raise OutputError(plan.path, "is the input itself", "choose another name")
    if existing and not options.overwrite:
        raise OutputError(existing[0], "exists already", "choose another name or --overwrite")
    for one in existing:
        check_name(one)
    check_folder(plan.path)


def _existing(plan: OutputPlan, frame_range: FrameRange) -> list[Path]:
    if plan.pattern is None:
        return [plan.path] if os.path.lexists(plan.path) else []
    wanted = (n for n in plan.pattern.numbers(anything=True) if frame_range.holds(n, Fraction(0)))
    return [plan.pattern.path_for(number) for number in wanted]


def _is_source(plan: OutputPlan, existing: list[Path], source: MediaInfo) -> bool:
    if not existing:
        return False
    inputs = [source.path]
    pattern = NumberedPattern.parse(source.path) if source.kind == "sequence" else None
    if pattern is not None:
        inputs = [pattern.path_for(number) for number in pattern.numbers()]
    known = {path.resolve() for path in inputs}
    if any(path.resolve() in known for path in existing):
        return True
    if not inputs or not inputs[0].exists():  # a track is drawn without its source
        return False
    return any(path.is_file() and path.samefile(inputs[0]) for path in existing[:1])
