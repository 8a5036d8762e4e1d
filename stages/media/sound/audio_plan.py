"""What becomes of a source's sound, decided and tried before any work is done."""

import io
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from pathlib import Path

import av
from av.audio.codeccontext import AudioCodecContext
from av.audio.frame import AudioFrame
from av.audio.resampler import AudioResampler
from av.audio.stream import AudioStream
from av.container import InputContainer, OutputContainer

from stages.media.reading.container import DAMAGE, open_container, reason_of
from stages.media.sound.channels import Channels, channels_of
from stages.media.writing.codecs import Container
from warp_kernels.device.memory import refuse_if_short
from warp_kernels.errors import MediaError, OptionError

_TRIED_PACKETS = 50
"""Packets of the source that are converted once to see whether that works."""
_RATES = (8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000, 64000, 88200, 96000)
_OPUS_RATE = 48000
_BITS_PER_CHANNEL = 96_000
_LAYOUTS = {
    "aac": ("mono", "stereo", "3.0", "4.0", "5.0", "5.1"),
    "libopus": ("mono", "stereo", "3.0", "quad", "5.1", "5.1", "7.1", "7.1"),
    "flac": ("mono", "stereo", "3.0", "quad", "5.0", "5.1", "6.1", "7.1"),
}
"""Orders of an encoder that players know, by the number of channels at least. FFmpeg's Opus puts
the channels of 5.0 and 6.1 in wrong places; the next larger order holds them all."""
_USUAL = {3: "2.1", 4: "4.0", 5: "5.0", 6: "5.1", 7: "6.1", 8: "7.1"}
"""Orders that are understood where none is stated, by the number of channels."""
_LOSSLESS = "flac"
"""What uncompressed sound becomes where only its order of channels stands in the way."""
_RARELY_PLAYED = {"mp4": ("pcm_",)}
"""Codecs that a format holds and few players play there, by the beginning of their name."""


@dataclass(frozen=True)
class AudioPlan:
    """How sound gets into an output."""

    encoder: str | None
    """FFmpeg's encoder; None where packets are copied."""
    layout: str = ""
    """Order of the channels that the encoder takes; empty where packets are copied."""
    rate: int = 0
    """Samples per second of the encoder."""
    bit_rate: int = 0
    """Bits per second of the encoder."""
    notes: tuple[str, ...] = ()
    """Choices that were made, one sentence each."""


def plan_audio(path: Path, container: Container, mode: str) -> AudioPlan | None:
    """Decide what becomes of the sound, and try it on the beginning of the file.

    Args:
        path: The source.
        container: The format of the output.
        mode: One of `MODES`.

    Returns:
        The plan, or None if the sound cannot be read at all.

    Raises:
        OptionError: If packets are to be copied that the format cannot hold.
    """
    with open_container(path) as source:
        stream = best_audio(source)
        if stream is None:
            return None
        notes = []
        if len(source.streams.audio) > 1:
            notes.append(f"{len(source.streams.audio)} audio streams: stream {stream.index} kept")
        why = _reason_to_convert(stream, container, mode)
        if not why:
            return AudioPlan(None, notes=tuple(notes))
        keeps = why.endswith(_LOSSLESS)
        encoder = _LOSSLESS if keeps else container.audio or "aac"
        return _plan_conversion(source, stream, container, encoder, [*notes, why])


def plan_song(path: Path, container: Container) -> AudioPlan:
    """Decide how another sound gets under the film, and try it on its beginning.

    Args:
        path: The sound.
        container: The format of the output.

    Raises:
        MediaError: If it is not readable or holds no sound.
        OptionError: If it cannot be converted.
    """
    with open_container(path) as source:
        stream = best_audio(source)
        if stream is None:
            raise MediaError(path, "holds no sound", "give a file with sound")
        notes = []
        if len(source.streams.audio) > 1:
            notes.append(f"{path.name}: of several sounds stream {stream.index} is taken")
        encoder = container.audio or "aac"
        return _plan_conversion(source, stream, container, encoder, notes)


def best_audio(source: InputContainer) -> AudioStream | None:
    """The audio stream that a player would play, or None if there is none that can be read.

    Args:
        source: The opened file.
    """
    stream = source.streams.best("audio")
    if not isinstance(stream, AudioStream) or stream.codec_context is None:
        return None
    return stream


def add_encoder(output: OutputContainer, plan: AudioPlan) -> AudioStream:
    """Add a stream with the encoder of a plan.

    Args:
        output: The output; its header must not be written yet.
        plan: A plan with an encoder.

    Raises:
        av.FFmpegError: If the format does not take it.
    """
    assert plan.encoder is not None
    target = output.add_stream(plan.encoder, rate=plan.rate)
    if not isinstance(target, AudioStream):
        raise ValueError(f"{plan.encoder} is no audio encoder")
    target.codec_context.layout = plan.layout
    target.codec_context.bit_rate = plan.bit_rate
    return target


class Converter:
    """Decoded frames of any kind to frames that an encoder takes; the kind may change midway."""

    def __init__(self, codec: AudioCodecContext) -> None:
        """Prepare.

        Args:
            codec: The encoder.
        """
        self._codec = codec
        self._kind: tuple[str, str, int] | None = None
        self._resampler: AudioResampler | None = None

    def convert(self, frame: AudioFrame, channels: Channels) -> list[AudioFrame]:
        """Convert a frame.

        Args:
            frame: A decoded frame.
            channels: Its channels.
        """
        kind = (frame.format.name, channels.order, frame.sample_rate)
        made = []
        if kind != self._kind:
            made = self.flush()
            codec = self._codec
            self._resampler = AudioResampler(codec.format, codec.layout, codec.sample_rate)
            self._kind = kind
        assert self._resampler is not None
        return made + self._resampler.resample(frame)

    def flush(self) -> list[AudioFrame]:
        """What is still held back."""
        if self._resampler is None:
            return []
        resampler, self._resampler, self._kind = self._resampler, None, None
        return [frame for frame in resampler.resample(None) if frame is not None]


def _reason_to_convert(stream: AudioStream, container: Container, mode: str) -> str:
    """Why packets are not copied, as a note; nothing if they are."""
    name = stream.codec_context.codec.canonical_name
    held = _can_copy(stream, container.format)
    target = container.audio_name
    if mode == "copy":
        if held:
            return ""
        raise OptionError(
            f"--audio copy: {container.format} cannot hold {name} audio; write .mkv or leave the "
            "option out"
        )
    if mode == "aac" and target != "aac":
        raise OptionError(
            f"--audio aac: {container.format} holds {target}; write .mp4 or leave the option out"
        )
    if not held:
        return f"{container.format} cannot hold {name} audio: converted to {target}"
    channels = channels_of(stream.codec_context)
    if name.startswith("pcm_") and container.format == "matroska" and mode == "auto":
        usual = _USUAL.get(channels.count)
        if channels.count > 2 and channels.order not in (usual, f"{channels.count} channels"):
            return f"{container.format} cannot state {channels.order}: converted to {_LOSSLESS}"
    if mode == "aac" and name != target:
        return f"{name} audio is converted to {target}"
    if name.startswith(_RARELY_PLAYED.get(container.format, ("-",))):
        return (
            f"few players play {name} audio in {container.format}: converted to {target}; "
            "--audio copy carries it over"
        )
    return ""


def _can_copy(stream: AudioStream, format_name: str) -> bool:
    """Whether a format takes a stream's packets as they are, found by writing a header."""
    trial = av.open(io.BytesIO(), "w", format=format_name)
    try:
        trial.add_stream_from_template(stream)
        trial.start_encoding()
        trial.close()
    except DAMAGE as error:
        refuse_if_short(error)
        return False
    return True


def _plan_conversion(
    source: InputContainer,
    stream: AudioStream,
    container: Container,
    encoder: str,
    notes: list[str],
) -> AudioPlan:
    """The first order of channels, from as many as the sound has downwards, that works."""
    known = _LAYOUTS[encoder]
    heard, reason = _beginning(source, stream)
    channels = heard[0][1] if heard else channels_of(stream.codec_context)
    given = stream.codec_context.sample_rate
    rate = _OPUS_RATE if encoder == "libopus" or given not in _RATES else given
    for count in range(min(max(channels.count, 1), len(known)), 0, -1):
        plan = AudioPlan(encoder, known[count - 1], rate, _BITS_PER_CHANNEL * count, tuple(notes))
        try:
            _try(heard, plan, container)
        except DAMAGE as error:
            refuse_if_short(error)
            reason = reason_of(error)
            continue
        if count < channels.count:
            notes.append(f"the audio's {channels.count} channels are mixed down to {plan.layout}")
        return replace(plan, notes=tuple(notes))
    raise OptionError(
        f"the audio cannot be converted with {encoder} ({reason}); --no-audio leaves it out"
    )


def _beginning(
    source: InputContainer, stream: AudioStream
) -> tuple[list[tuple[AudioFrame, Channels]], str]:
    """Decoded frames of the beginning with their channels, and what went wrong if anything did."""
    heard: list[tuple[AudioFrame, Channels]] = []
    reason = ""
    packets = source.demux(stream)
    for _ in range(_TRIED_PACKETS):
        try:
            packet = next(packets, None)
            if packet is None:
                break
            frames = packet.decode()
        except DAMAGE as error:
            refuse_if_short(error)
            reason = reason_of(error)
            continue
        heard += [(f, channels_of(f)) for f in frames if isinstance(f, AudioFrame)]
    return heard, reason


def _try(heard: list[tuple[AudioFrame, Channels]], plan: AudioPlan, container: Container) -> None:
    """Convert the beginning of a sound and forget it.

    Raises:
        av.FFmpegError: If the encoder or the format refuses.
    """
    with av.open(io.BytesIO(), "w", format=container.format) as trial:
        target = add_encoder(trial, plan)
        trial.start_encoding()
        converter = Converter(target.codec_context)
        for frame, channels in islice(heard, _TRIED_PACKETS):
            pts, base = frame.pts, frame.time_base
            for made in converter.convert(frame, channels):
                target.encode(made)
            frame.pts, frame.time_base = pts, base or Fraction(1, 1000)
