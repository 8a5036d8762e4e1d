"""Colour gradients of triangles as SVG knows them: two places, and a colour at each."""

from dataclasses import dataclass

import numpy as np

from warp_kernels.drawing.paint import Paint

EVEN = 0.5
"""Code values: channels that change by less over a triangle are written as one colour."""
SHORTEST = 1e-12
"""Squares of slopes are taken to be no smaller."""


@dataclass(frozen=True, eq=False)
class Slopes:
    """One gradient for each of some triangles; beyond the places colours stay as they are there."""

    begins: np.ndarray
    """Where the first colour is [px of the picture], [N, 2]."""
    ends: np.ndarray
    """Where the second one is, [N, 2]."""
    first: np.ndarray
    """Colours [code values], [N, 3] uint8."""
    last: np.ndarray
    """The same, [N, 3] uint8."""

    @property
    def is_even(self) -> np.ndarray:
        """Where both colours are the same, [N] bool."""
        return np.asarray((self.first == self.last).all(axis=1))


def channel_slopes(paint: Paint, channel: int) -> Slopes:
    """The gradients of one channel, the others black: not rounded but in the places.

    The places are those where the channel has a whole code value.

    Args:
        paint: Linear colours.
        channel: 0 to 2.
    """
    centres = paint.corners.mean(axis=1)
    slopes = paint.gradients[:, :, channel]
    middle = paint.colors[:, channel]
    away = paint.corners - centres[:, None]
    values = middle[:, None] + np.einsum("tij,tj->ti", away, slopes)
    lowest, highest = paint.limits[:, :, channel].T
    values = np.clip(values, lowest[:, None], highest[:, None])
    low, high = values.min(axis=1), values.max(axis=1)
    is_even = high - low < EVEN
    low, high = np.floor(low), np.ceil(high)
    whole = np.rint(np.clip(middle, lowest, highest))
    low, high = np.where(is_even, whole, low), np.where(is_even, whole, high)
    square = np.maximum((slopes * slopes).sum(axis=1), SHORTEST)
    begins = centres + ((low - middle) / square)[:, None] * slopes
    ends = centres + ((high - middle) / square)[:, None] * slopes
    colors = np.zeros((2, len(low), 3), np.uint8)
    colors[0, :, channel], colors[1, :, channel] = low, high
    return Slopes(begins, ends, *colors)


def best_slopes(paint: Paint) -> tuple[Slopes, np.ndarray]:
    """The single gradient for all channels that is nearest to theirs.

    Args:
        paint: Linear colours.

    Returns:
        The gradients; how far their colours are off the linear ones where nothing is limited, as
        the mean square over the triangle and the channels [code values^2], [N].
    """
    centres = paint.corners.mean(axis=1)
    away = paint.corners - centres[:, None]
    # positions are spread over a triangle as over its corners, divided by 4
    spread, turned = np.linalg.eigh(np.einsum("tki,tkj->tij", away, away) / 12.0)
    root = np.sqrt(np.maximum(spread, SHORTEST))
    # colours over positions of which a triangle has as much in every direction
    even = root[:, :, None] * np.einsum("tij,tic->tjc", turned, paint.gradients)
    parts, chosen = np.linalg.eigh(np.einsum("tic,tjc->tij", even, even))
    along = chosen[:, :, 1]
    change = np.einsum("ti,tic->tc", along, even)
    slopes = np.einsum("tij,tj->ti", turned, along / root)
    steps = np.einsum("tki,ti->tk", away, slopes)
    square = np.maximum((slopes * slopes).sum(axis=1), SHORTEST)
    places, colors = [], []
    for step in (steps.min(axis=1), steps.max(axis=1)):
        places.append(centres + (step / square)[:, None] * slopes)
        color = paint.colors + step[:, None] * change
        color = np.clip(color, paint.limits[:, 0], paint.limits[:, 1])
        colors.append(np.rint(color).astype(np.uint8))
    return Slopes(*places, *colors), np.maximum(parts[:, 0], 0.0) / 3.0
