"""A file's sound as arrays, placed in time: what is listened to, or laid under another film."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from av.audio.frame import AudioFrame
from av.audio.layout import AudioLayout
from av.audio.resampler import AudioResampler
from av.audio.stream import AudioStream
from av.container import InputContainer

from stages.media.reading.container import DAMAGE, choose_video, open_container, reason_of
from stages.media.reading.probe import probe
from stages.media.sound.audio_plan import best_audio
from stages.media.sound.channels import channels_of
from warp_kernels.device.memory import refuse_if_short
from warp_kernels.errors import MediaError, TrimotionError

_GAP = 0.1
"""Sound that is missing for longer than this is filled with silence, as players do [s]."""
_LONGEST_GAP = 3600.0
"""A clock that jumps further is mistaken, and the sound goes on at once [s]."""
_FEWEST = 16
"""Samples at least; less is no sound."""


@dataclass(frozen=True)
class SampleForm:
    """How samples are wanted."""

    rate: int
    """Samples a second."""
    layout: str | None = None
    """Order of the channels; None for the mean of all as one channel."""


def samples_of(
    path: Path, form: SampleForm, problems: list[str] | None = None
) -> Iterator[np.ndarray]:
    """Read a sound from its time 0 on, in pieces.

    The time 0 is the first picture's of a film, else the first sample's. What comes before it is
    dropped, and silence stands where there is no sound yet.

    Args:
        path: What FFmpeg reads.
        form: How samples are wanted.
        problems: Takes one sentence on damage that was passed over.

    Returns:
        Arrays [channels, N] float32, -1 to 1.

    Raises:
        MediaError: If it is not readable or holds no sound.
    """
    with open_container(path) as source:
        stream = best_audio(source)
        if stream is None:
            raise MediaError(path, "holds no sound", "give a file with sound")
        zero = _zero_of(source, path)
        pieces, total = _Pieces(form, zero), 0
        for frame, time in _decoded(source, stream, [] if problems is None else problems):
            for piece in pieces.add(frame, time):
                total += piece.shape[1]
                yield piece
        for piece in pieces.flush():
            total += piece.shape[1]
            yield piece
        if total < _FEWEST:
            raise MediaError(path, "no sound can be decoded", "check or convert the file")


def _zero_of(source: InputContainer, path: Path) -> Fraction | None:
    """When a film's first picture is shown [s of the file]; None where there is no film."""
    try:
        choose_video(source, path)
        return probe(path).start_time
    except TrimotionError:
        return None


def _decoded(
    source: InputContainer, stream: AudioStream, problems: list[str]
) -> Iterator[tuple[AudioFrame, Fraction | None]]:
    """Frames and when they sound [s of the file]; damage is passed over and told."""
    packets = source.demux(stream)
    while True:
        try:
            packet = next(packets, None)
        except DAMAGE as error:
            refuse_if_short(error)
            problems.append(f"the sound breaks off ({reason_of(error)})")
            return
        if packet is None:
            return
        try:
            frames: list[Any] = packet.decode()
        except DAMAGE as error:
            refuse_if_short(error)
            if not problems:
                problems.append(f"damaged sound is left out ({reason_of(error)})")
            continue
        for frame in frames:
            if isinstance(frame, AudioFrame):
                yield frame, _time_of(frame)


def _time_of(frame: AudioFrame) -> Fraction | None:
    """When a frame sounds [s of the file]."""
    if frame.pts is None or not frame.time_base:
        return None
    return frame.pts * Fraction(frame.time_base)


class _Pieces:
    """Decoded frames of any kind to arrays, each where it belongs; the kind may change midway."""

    def __init__(self, form: SampleForm, zero: Fraction | None) -> None:
        """Prepare.

        Args:
            form: How samples are wanted.
            zero: The time 0 [s of the file]; None for that of the first frame.
        """
        self._form = form
        self._zero = zero
        self._kind: tuple[str, str, int] | None = None
        self._resampler: AudioResampler | None = None
        self._next: Fraction | None = None
        self._early = 0

    def add(self, frame: AudioFrame, time: Fraction | None) -> Iterator[np.ndarray]:
        """Samples of a frame, after silence where sound is missing before it.

        Args:
            frame: A decoded frame.
            time: When it sounds [s of the file], or None for right now.
        """
        order = channels_of(frame).order
        if self._next is None:
            self._next = time or Fraction(0)
            self._zero = self._next if self._zero is None else self._zero
            missing = self._next - self._zero
            self._early = max(0, round(-missing * self._form.rate))
            yield from self._silence(float(missing))
        elif time is not None and _GAP < time - self._next < _LONGEST_GAP:
            yield from self.flush()
            yield from self._silence(float(time - self._next))
            self._next = time
        kind = (frame.format.name, order, frame.sample_rate)
        if kind != self._kind:
            yield from self.flush()
            layout = self._form.layout or frame.layout
            self._resampler = AudioResampler("fltp", layout, self._form.rate)
            self._kind = kind
        self._next += Fraction(frame.samples, frame.sample_rate)
        assert self._resampler is not None
        frame.pts = None  # else the resampler fills gaps of its own accord
        for made in self._resampler.resample(frame):
            yield from self._shown(made)

    def flush(self) -> Iterator[np.ndarray]:
        """What is still held back."""
        if self._resampler is None:
            return
        resampler, self._resampler, self._kind = self._resampler, None, None
        for made in resampler.resample(None):
            if made is not None:
                yield from self._shown(made)

    def _shown(self, made: AudioFrame) -> Iterator[np.ndarray]:
        """Samples as they are wanted, without what lies before the time 0."""
        channels_of(made)
        samples = made.to_ndarray()
        if self._form.layout is None:
            samples = samples.mean(axis=0, keepdims=True, dtype=np.float32)
        dropped = min(self._early, samples.shape[1])
        self._early -= dropped
        if dropped < samples.shape[1]:
            yield np.nan_to_num(samples[:, dropped:], copy=False, posinf=0.0, neginf=0.0)

    def _silence(self, seconds: float) -> Iterator[np.ndarray]:
        """Silence in pieces."""
        channels = 1 if self._form.layout is None else AudioLayout(self._form.layout).nb_channels
        left = round(seconds * self._form.rate)
        while left > 0:
            count = min(left, self._form.rate)
            left -= count
            yield np.zeros((channels, count), np.float32)
