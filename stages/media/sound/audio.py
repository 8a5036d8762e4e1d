"""The source's sound, carried over beside the new pictures."""

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
from av.audio.frame import AudioFrame
from av.audio.stream import AudioStream
from av.container import InputContainer, OutputContainer
from av.packet import Packet

from stages.media.reading.container import DAMAGE, open_container, reason_of
from stages.media.sound.audio_plan import AudioPlan, Converter, add_encoder, best_audio
from stages.media.sound.channels import Channels, channels_of
from warp_kernels.device.memory import refuse_if_short

_RESTART = Fraction(1, 2)
"""A clock that falls back by more than this has restarted [s]."""
_PRIMING = Fraction(1, 8)
"""Sound that a decoder needs before the first that is heard, at most [s]."""


def open_audio(path: Path, output: OutputContainer, plan: AudioPlan) -> "AudioTrack | None":
    """Open a file's sound a second time and add a stream for it to an output.

    Args:
        path: The source.
        output: The output; its header must not be written yet.
        plan: What becomes of the sound.

    Returns:
        The track, or None if the sound is gone since the plan was made.

    Raises:
        av.FFmpegError: If the format does not take it.
    """
    source = open_container(path)
    stream = best_audio(source)
    if stream is None:
        source.close()
        return None
    try:
        if plan.encoder is None:
            copied = output.add_stream_from_template(stream)
            return _CopiedTrack(source, stream, copied, output)
        return _EncodedTrack(source, stream, add_encoder(output, plan), output)
    except BaseException:
        source.close()
        raise


class AudioTrack:
    """Sound that is handed to the muxer in step with the pictures, so little is held."""

    def __init__(
        self,
        source: InputContainer,
        stream: AudioStream,
        target: AudioStream,
        output: OutputContainer,
    ) -> None:
        """Prepare; use `open_audio`.

        Args:
            source: The source, opened for the sound alone.
            stream: Its audio stream.
            target: The stream in the output.
            output: The output.
        """
        self.problem = ""
        """Why the sound ended early; empty if it did not."""
        self._source = source
        self._stream = stream
        self._target = target
        self._output = output
        self._start: Fraction | None = None
        self._limit: Fraction | None = Fraction(0)
        self._end: Fraction | None = None
        self._offset = Fraction(0)
        self._steps: Iterator[bool | None] | None = None
        language = stream.metadata.get("language")
        if language:
            target.metadata["language"] = language

    def begin(self, start: Fraction | None) -> None:
        """Say where the sound starts.

        Args:
            start: Sound before this time is dropped and the rest moved to 0 [s of the source];
                None to keep all of it where it is.
        """
        self._start = start
        if start is not None and start > 10:
            try:
                self._source.seek(int((start - 2) * av.time_base))
            except DAMAGE:
                self._source.seek(0)

    def advance(self, time: Fraction | None) -> None:
        """Hand over the sound that starts before a time.

        Args:
            time: The time [s of the source]; None for all that is left.

        Raises:
            av.FFmpegError: If the output cannot be written.
        """
        self._limit = time
        steps = self._steps = self._steps or self._run()
        while next(steps, False) is None:
            pass

    def finish(self, end: Fraction | None) -> None:
        """Hand over the last sound.

        Args:
            end: Where it ends [s of the source]; None for the end of the file.

        Raises:
            av.FFmpegError: If the output cannot be written.
        """
        self.advance(end)
        self._flush()

    def close(self) -> None:
        """Release the source."""
        self._source.close()

    def _run(self) -> Iterator[bool | None]:
        """Handle one packet a step: None after one was handled, True where it is too early."""
        packets = self._source.demux(self._stream)
        while True:
            try:
                packet = next(packets, None)
            except DAMAGE as error:
                refuse_if_short(error)
                self.problem = f"the audio breaks off ({reason_of(error)})"
                packet = None
            if packet is None:
                break
            time = self._continuous_time(packet)
            while time is not None and self._limit is not None and time >= self._limit:
                yield True
            if packet.size:
                self._handle(packet, time)
            yield None

    def _continuous_time(self, packet: Packet) -> Fraction | None:
        """Time of a packet [s of the source]; goes on where the file's clock restarts."""
        ticks = packet.pts if packet.pts is not None else packet.dts
        if ticks is None:
            return None
        time = ticks * Fraction(packet.time_base) + self._offset
        if self._end is not None and time < self._end - _RESTART:
            self.problem = "the audio's clock restarts: it is joined where it breaks"
            self._offset += self._end - time
            time = self._end
        self._end = time + (packet.duration or 0) * Fraction(packet.time_base)
        return time

    def _handle(self, packet: Packet, time: Fraction | None) -> None:
        raise NotImplementedError

    def _flush(self) -> None:
        """Hand over what an encoder still holds."""


class _CopiedTrack(AudioTrack):
    """Packets as they are."""

    _last_dts: Fraction | None = None
    _hidden: list[tuple[Packet, Fraction]] | None = None

    def begin(self, start: Fraction | None) -> None:
        """Say where the sound starts; see the base class."""
        super().begin(start)
        self._hidden = []

    def _handle(self, packet: Packet, time: Fraction | None) -> None:
        """Copy a packet; of what an edit list cuts off only what the decoder needs."""
        if time is None or (self._start is not None and time < self._start):
            return
        if packet.is_discard:
            if self._hidden is not None:
                recent = [entry for entry in self._hidden if entry[1] >= time - _PRIMING]
                self._hidden = [*recent, (packet, time)]
            return
        hidden, self._hidden = self._hidden or [], None
        for earlier, begun in hidden:
            if begun >= time - _PRIMING:
                self._copy(earlier)
        self._copy(packet)

    def _copy(self, packet: Packet) -> None:
        base = Fraction(packet.time_base)
        shift = round((self._offset - (self._start or 0)) / base)
        pts = packet.dts if packet.pts is None else packet.pts
        packet.pts = (pts or 0) + shift
        packet.dts = packet.pts if packet.dts is None else packet.dts + shift
        dts = packet.dts * base
        if self._last_dts is not None and dts <= self._last_dts:
            self.problem = "audio packets that run backwards are left out"
            return
        self._last_dts = dts
        packet.stream = self._target
        self._output.mux(packet)


class _EncodedTrack(AudioTrack):
    """Sound that is decoded and encoded anew."""

    _converter: Converter | None = None

    def _handle(self, packet: Packet, time: Fraction | None) -> None:
        try:
            frames: list[Any] = packet.decode()
        except DAMAGE as error:
            refuse_if_short(error)
            self.problem = f"damaged audio packets are left out ({reason_of(error)})"
            return
        sounds = [frame for frame in frames if isinstance(frame, AudioFrame)]
        for frame, channels in [(sound, channels_of(sound)) for sound in sounds]:
            if frame.pts is not None and frame.time_base:
                base = Fraction(frame.time_base)
                if self._start is not None and frame.pts * base + self._offset < self._start:
                    continue
                frame.pts += round((self._offset - (self._start or 0)) / base)
                self._encode(frame, channels)

    def _encode(self, frame: AudioFrame, channels: Channels) -> None:
        converter = self._converter = self._converter or Converter(self._target.codec_context)
        try:
            made = converter.convert(frame, channels)
        except DAMAGE as error:
            refuse_if_short(error)
            self.problem = f"audio that changes its kind is left out ({reason_of(error)})"
            return
        for converted in made:
            self._output.mux(self._target.encode(converted))

    def _flush(self) -> None:
        for converted in self._converter.flush() if self._converter else []:
            self._output.mux(self._target.encode(converted))
        self._output.mux(self._target.encode(None))
