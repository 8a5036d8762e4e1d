"""Another sound under a film: moved, cut at the film's end, or filled up with silence."""

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
from av.audio.frame import AudioFrame
from av.container import OutputContainer

from stages.media.sound.audio_plan import AudioPlan, add_encoder
from stages.media.sound.samples import SampleForm, samples_of

_TOLD = Fraction(1, 10)
"""A sound that is shorter than its film by less than this is as long [s]."""


class SongTrack:
    """A sound that is decoded, cut to the sample, and encoded in step with the pictures."""

    def __init__(self, path: Path, output: OutputContainer, plan: AudioPlan) -> None:
        """Prepare.

        Args:
            path: The sound.
            output: The output; its header must not be written yet.
            plan: How it is encoded.
        """
        self.problem = ""
        """Why the sound is not all there, or that it ends early; empty for nothing to tell."""
        self._path = path
        self._output = output
        self._target = add_encoder(output, plan)
        self._form = SampleForm(plan.rate, plan.layout)
        self._problems: list[str] = []
        self._held: np.ndarray | None = None
        self._count = 0
        self._heard = False
        self._late = False
        self._pieces: Iterator[np.ndarray] = iter(())

    def begin(self, start: Fraction) -> None:
        """Say where the sound begins.

        Args:
            start: When the output plays the sound's time 0 [s of the output]; below 0 to begin
                within it.
        """
        self._late = start > 0
        self._pieces = self._moved(round(start * self._form.rate))

    def advance(self, time: Fraction) -> None:
        """Hand over the sound before a time.

        Args:
            time: The time [s of the output].

        Raises:
            av.FFmpegError: If the output cannot be written.
        """
        wanted = round(time * self._form.rate) - self._count
        while wanted > 0:
            if self._held is None or not self._held.shape[1]:
                self._held = next(self._pieces, None)
                if self._held is None:
                    return
            taken = min(wanted, self._held.shape[1])
            self._encode(self._held[:, :taken])
            self._held = self._held[:, taken:]
            wanted -= taken

    def finish(self, end: Fraction) -> None:
        """Hand over the last sound, and silence where there is no more.

        Args:
            end: When the film ends [s of the output].

        Raises:
            av.FFmpegError: If the output cannot be written.
        """
        self.advance(end)
        missing = round(end * self._form.rate) - self._count
        if not self._heard:
            where = "begins after the film" if self._late else "is over before the film"
            self.problem = f"nothing of {self._path.name} is heard: with this offset it {where}"
        elif missing > _TOLD * self._form.rate:
            early = f"{missing / self._form.rate:.1f} s before the film"
            self.problem = f"{self._path.name} ends {early}: silence follows"
        while missing > 0:
            block = min(missing, self._form.rate)
            self._encode(np.zeros((self._target.codec_context.channels, block), np.float32))
            missing -= block
        if self._problems:
            self.problem = self._problems[0]
        self._output.mux(self._target.encode(None))

    def close(self) -> None:
        """Release the sound."""
        self._pieces = iter(())

    def _moved(self, shift: int) -> Iterator[np.ndarray]:
        """Pieces of the sound, after silence or without its beginning.

        Args:
            shift: By how much it is later [samples].
        """
        channels = self._target.codec_context.channels
        while shift > 0:
            block = min(shift, self._form.rate)
            shift -= block
            yield np.zeros((channels, block), np.float32)
        for piece in samples_of(self._path, self._form, self._problems):
            dropped = min(-shift, piece.shape[1])
            shift += dropped
            if dropped < piece.shape[1]:
                self._heard = True
                yield piece[:, dropped:]

    def _encode(self, samples: np.ndarray) -> None:
        """Encode samples, [channels, N]."""
        codec = self._target.codec_context
        whole = np.ascontiguousarray(np.clip(samples, -1.0, 1.0))
        frame = AudioFrame.from_ndarray(whole, format="fltp", layout=self._form.layout or "mono")
        frame.sample_rate, frame.pts = codec.sample_rate, self._count
        frame.time_base = Fraction(1, codec.sample_rate)
        self._count += samples.shape[1]
        self._output.mux(self._target.encode(frame))
