"""The frames of an output beside those of its source, at the source's size."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from pipeline.compare.resample import resample
from stages.frame import Frame
from stages.media import Decoder
from warp_kernels.errors import TrimotionError

TIME_TOLERANCE = Fraction(6, 1000)
"""Times that differ by less are the same [s]: GIF keeps hundredths, Matroska thousandths."""
ASPECT_TOLERANCE = 0.02
"""Relative difference of two shapes that still counts as a change of size only."""


@dataclass(frozen=True, eq=False, slots=True)
class Matched:
    """A frame of a source and what became of it."""

    frame: Frame
    """The frame of the source."""
    shown: np.ndarray
    """What the output shows, code values at the source's size, [H, W, 3] uint8 or float64."""
    time: Fraction
    """Its time [s from the first frame that is compared]."""


def matched(original: Decoder, result: Decoder) -> Iterator[Matched]:
    """Frames of both that belong together.

    They are matched by their time from the first one; numbered stills carry no times and are
    matched by their order.

    Args:
        original: The source.
        result: The output, of the source's shape; it is scaled to its size.

    Raises:
        TrimotionError: If a frame has no partner.
    """
    crop = is_padded(original, result)
    for before, after, time in _pairs(original, result):
        height, width = before.pixels.shape[:2]
        shown = after.pixels[:height, :width] if crop else resample(after.pixels, (width, height))
        yield Matched(before, shown, time)


def is_padded(original: Decoder, result: Decoder) -> bool:
    """Whether the output has the source's size, or that with its odd sides made even.

    Raises:
        TrimotionError: If the two have different shapes.
    """
    source, output = original.info, result.info
    extra = (output.width - source.width, output.height - source.height)
    if all(more in (0, side % 2) for more, side in zip(extra, size_of(original), strict=True)):
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


def size_of(decoder: Decoder) -> tuple[int, int]:
    """Width and height of a source or an output [px]."""
    return decoder.info.width, decoder.info.height


def size_notes(original: Decoder, result: Decoder) -> Iterator[str]:
    """How the two were made comparable, one sentence each."""
    if size_of(original) == size_of(result):
        return
    written = "{}x{}".format(*size_of(result))
    yield (
        f"the output is {written}: its padding is left out"
        if is_padded(original, result)
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
                "say with --frames A-B which frames of the source it shows"
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
        f"say with --frames which of them it shows, such as --frames 0-{counts[1] - 1}"
    )
