"""How close an output is to its source, frame by frame."""

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.resample import resample
from stages.frame import Frame
from stages.media import Decoder, FrameRange, open_decoder
from warp_kernels.errors import TrimotionError

TIME_TOLERANCE = Fraction(6, 1000)
"""Times that differ by less are the same [s]: GIF keeps hundredths, Matroska thousandths."""
ASPECT_TOLERANCE = 0.02
"""Relative difference of two shapes that still counts as a change of size only."""


@dataclass(frozen=True)
class FrameError:
    """Error of one frame."""

    frame: int
    """Its number in the source."""
    time: Fraction
    """Its time [s from the first frame that was compared]."""
    squared_error: float
    """Mean over pixels and channels of the squared difference [code value^2]."""

    @property
    def rmse(self) -> float:
        """Root mean square over pixels and channels [code values]."""
        return math.sqrt(self.squared_error)

    @property
    def psnr(self) -> float:
        """Peak signal to noise ratio [dB]; infinite where nothing differs."""
        return psnr(self.squared_error)

    @property
    def residual(self) -> float:
        """R of the paper: sqrt(sum E / |I|), E being half the squared error over all channels.

        Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Eq. 12.
        """
        return math.sqrt(1.5 * self.squared_error)

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON; an infinite ratio is null."""
        return {
            "frame": self.frame,
            "time": float(self.time),
            "rmse": self.rmse,
            "psnr": self.psnr if math.isfinite(self.psnr) else None,
            "R": self.residual,
        }


@dataclass(frozen=True)
class Report:
    """Errors of a clip."""

    source: Path
    """What was converted."""
    output: Path
    """What came out."""
    size: tuple[int, int]
    """Width and height at which they were compared [px]."""
    frames: tuple[FrameError, ...]
    """One entry for every frame."""
    notes: tuple[str, ...]
    """How they were made comparable, one sentence each."""

    @property
    def rmse(self) -> float:
        """Mean over the frames [code values]."""
        return float(np.mean([frame.rmse for frame in self.frames]))

    @property
    def residual(self) -> float:
        """Mean over the frames of R [code values]."""
        return float(np.mean([frame.residual for frame in self.frames]))

    @property
    def psnr(self) -> float:
        """Ratio of the clip as a whole [dB], so that one equal frame does not make it infinite."""
        return psnr(float(np.mean([frame.squared_error for frame in self.frames])))

    @property
    def worst(self) -> FrameError:
        """The frame with the largest error."""
        return max(self.frames, key=lambda frame: frame.squared_error)

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "source": str(self.source),
            "output": str(self.output),
            "width": self.size[0],
            "height": self.size[1],
            "frames": len(self.frames),
            "rmse": self.rmse,
            "psnr": self.psnr if math.isfinite(self.psnr) else None,
            "R": self.residual,
            "worst": self.worst.as_dict(),
            "notes": list(self.notes),
            "per_frame": [frame.as_dict() for frame in self.frames],
        }

    def as_json(self) -> str:
        """All figures."""
        return json.dumps(self.as_dict(), indent=2)

    def as_table(self) -> str:
        """The figures of the clip and of its worst frame."""
        worst = self.worst
        rows = [
            ("", "rmse", "PSNR [dB]", "R"),
            ("mean", *_figures(self.rmse, self.psnr, self.residual)),
            (f"worst (frame {worst.frame})", *_figures(worst.rmse, worst.psnr, worst.residual)),
        ]
        width = max(len(row[0]) for row in rows)
        noun = "frame" if len(self.frames) == 1 else "frames"
        lines = [f"{len(self.frames)} {noun} at {self.size[0]}x{self.size[1]}"]
        for label, *figures in rows:
            lines.append(f"{label:<{width}}" + "".join(f"{figure:>11}" for figure in figures))
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])


def measure(source: Path, output: Path, frame_range: FrameRange) -> Report:
    """Compare an output with its source.

    Frames are matched by their time from the first one that is compared; numbered stills carry
    no times and are matched by their order.

    Args:
        source: What was converted.
        output: What came out; scaled to the source's size if it has another.
        frame_range: The frames of the source that the output shows.

    Raises:
        MediaError: If one of the two cannot be read.
        TrimotionError: If their shapes or their frames do not match.
    """
    with open_decoder(source, frame_range) as original, open_decoder(output) as result:
        size = (original.info.width, original.info.height)
        crop = _padding_of(original, result)
        frames = tuple(
            FrameError(before.index, time, _squared_error(before.pixels, after.pixels, crop))
            for before, after, time in _pairs(original, result)
        )
        notes = (*_notes(original, result, crop), *original.warnings, *result.warnings)
        return Report(source, output, size, frames, notes)


def psnr(squared_error: float) -> float:
    """Peak signal to noise ratio [dB] of a mean squared error [code value^2]."""
    return math.inf if squared_error == 0 else 10 * math.log10(255.0**2 / squared_error)


def _figures(*values: float) -> Iterator[str]:
    return (f"{value:.3f}" for value in values)


def _squared_error(before: np.ndarray, after: np.ndarray, crop: bool) -> float:
    """Mean squared difference of two pictures, [H, W, 3] uint8 each [code value^2]."""
    height, width = before.shape[:2]
    after = after[:height, :width] if crop else resample(after, (width, height))
    difference = before.astype(np.float64) - after
    return float(np.mean(np.square(difference)))


def _padding_of(original: Decoder, result: Decoder) -> bool:
    """Whether the output is the source, or that with its odd sides made even.

    Raises:
        TrimotionError: If the two have different shapes.
    """
    source, output = original.info, result.info
    extra = (output.width - source.width, output.height - source.height)
    if all(more in (0, side % 2) for more, side in zip(extra, _size(original), strict=True)):
        return True
    relative = (output.width / source.width) / (output.height / source.height)
    slack = ASPECT_TOLERANCE + 1.0 / min(output.width, output.height)
    if abs(math.log(relative)) > slack:
        raise TrimotionError(
            f"{output.path}: {output.width}x{output.height} has another shape than "
            f"{source.path} with {source.width}x{source.height}; compare a source with what was "
            "made from it"
        )
    return False


def _size(decoder: Decoder) -> tuple[int, int]:
    return decoder.info.width, decoder.info.height


def _notes(original: Decoder, result: Decoder, crop: bool) -> Iterator[str]:
    if _size(original) == _size(result):
        return
    written = "{}x{}".format(*_size(result))
    yield (
        f"the output is {written}: its padding is left out"
        if crop
        else f"the output is {written}: scaled to the source's size"
    )


def _pairs(original: Decoder, result: Decoder) -> Iterator[tuple[Frame, Frame, Fraction]]:
    """Frames of both that belong together, and their time from the first one [s].

    Raises:
        TrimotionError: If a frame has no partner.
    """
    by_order = "sequence" in (original.info.kind, result.info.kind)
    first: tuple[Fraction, Fraction] | None = None
    count = 0
    while True:
        before, after = next(original, None), next(result, None)
        if before is None and after is None:
            return
        if before is None or after is None:
            raise _unequal_counts(original, result, before is None, count)
        times = (before.pts * before.time_base, after.pts * after.time_base)
        first = first or times
        since = (times[0] - first[0], times[1] - first[1])
        if not by_order and abs(since[0] - since[1]) > TIME_TOLERANCE:
            raise TrimotionError(
                f"{result.info.path}: its frame {count} is shown at {float(since[1]):.3f} s, "
                f"that of {original.info.path} at {float(since[0]):.3f} s; "
                "compare the frames it was made from (--frames)"
            )
        count += 1
        yield before, after, since[0]


def _unequal_counts(
    original: Decoder, result: Decoder, output_is_longer: bool, count: int
) -> TrimotionError:
    """The error that states both numbers of frames."""
    rest = 1 + sum(1 for _ in (result if output_is_longer else original))
    counts = (count, count + rest) if output_is_longer else (count + rest, count)
    return TrimotionError(
        f"{result.info.path}: has {counts[1]} frames, {original.info.path} has {counts[0]}; "
        "compare the frames it was made from (--frames)"
    )
