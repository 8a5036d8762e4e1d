"""Grade and palette of a look, and what they make of the colours of triangles.

They change colours, not pixels: a triangle of one colour becomes one of another colour, a gradient
becomes the gradient between changed colours, and what styles draw by themselves (ink, paper, seams)
stays as it was said to be.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stages.toning.choices import Choices
from stages.toning.grade import Grade
from stages.toning.oklab_colors import to_codes, to_lab
from stages.toning.palette import Palette
from warp_kernels.drawing.paint import Paint

WIDEST = 48.0
"""A slope is told by colours that are at most so far from the mean [code values]."""


@dataclass(frozen=True)
class Tone:
    """What is done to the colours of a look: first the grade, then the palette."""

    grade: Grade
    """The grade."""
    palette: Palette | None = None
    """The palette, or None."""

    @property
    def is_plain(self) -> bool:
        """Whether nothing is done."""
        return self.grade.is_plain and (self.palette is None or self.palette.amount == 0.0)

    def graded(self, colors: np.ndarray) -> np.ndarray:
        """Colours [code values], [N, 3], as the palette sees them: L, a, b."""
        lab = to_lab(colors)
        return lab if self.grade.is_plain else self.grade.applied(lab)

    def toned(self, colors: np.ndarray, numbers: np.ndarray | None) -> np.ndarray:
        """What becomes of colours, not cut off [code values], [N, 3].

        Args:
            colors: Colours [code values], [N, 3].
            numbers: Which colours of the palette they become, [N]; None if it is `map`.
        """
        lab = self.graded(colors)
        if self.palette is not None and self.palette.amount > 0.0:
            lab = self.palette.applied(lab, numbers)
        return to_codes(lab)


def toned(paint: Paint, tone: Tone, choices: Choices | None = None) -> Paint:
    """Triangles in other colours.

    Args:
        paint: The triangles.
        tone: What is done to their colours.
        choices: Which colours of the palette they have taken; None for the nearest.

    Returns:
        The same triangles; the very same object if nothing is done.
    """
    if tone.is_plain:
        return paint
    numbers = _numbers(paint, tone, choices)
    colors = np.clip(tone.toned(paint.colors, numbers), 0.0, 255.0)
    gradients, curvatures = paint.gradients, paint.curvatures
    limits = _limits(paint, tone, numbers, colors)
    if curvatures is not None:
        reach = np.sqrt(np.abs(_doubled_areas(*_sides(paint)))) / 3.0  # from the centre, in mean
        slopes = np.concatenate([gradients, curvatures], axis=1)
        steps = [reach, reach, np.ones_like(reach), *3 * [reach**2]]
        slopes = _changes(paint, tone, numbers, slopes, steps)
        gradients, curvatures = slopes[:, :2], slopes[:, 2:]
    elif gradients.any():
        at_corners = _at_corners(paint, tone, numbers)
        gradients = _through(paint, at_corners)
        # the way between colours of a palette must not lead beyond these
        ends = np.concatenate([at_corners, colors[:, None]], axis=1)
        around = np.stack([ends.min(axis=1), ends.max(axis=1)], axis=1)
        limits = np.clip(around, limits[:, :1], limits[:, 1:])
    return replace(paint, colors=colors, gradients=gradients, curvatures=curvatures, limits=limits)


def _numbers(paint: Paint, tone: Tone, choices: Choices | None) -> np.ndarray | None:
    """Which colours of the palette triangles become, [N]; None if it is no `nearest`."""
    palette = tone.palette
    if palette is None or not palette.is_nearest:
        return None
    lab = tone.graded(paint.colors)
    return (choices or Choices.none()).taken(paint.ids, lab, palette)


def _limits(paint: Paint, tone: Tone, numbers: np.ndarray | None, colors: np.ndarray) -> np.ndarray:
    """What changed gradients keep to, [N, 2, 3]: where they were free they stay so."""
    free = np.array([[0.0], [255.0]])
    is_free = paint.limits == free
    if is_free.all():
        return np.ascontiguousarray(paint.limits)
    ends = [tone.toned(paint.limits[:, end], numbers) for end in (0, 1)]
    ends = [np.clip(end, 0.0, 255.0) for end in ends]
    least, most = np.minimum.reduce([*ends, colors]), np.maximum.reduce([*ends, colors])
    return np.where(is_free, free, np.stack([least, most], axis=1))


def _at_corners(paint: Paint, tone: Tone, numbers: np.ndarray | None) -> np.ndarray:
    """What becomes of the colours at the corners [code values], [N, 3, 3]."""
    away = paint.corners - paint.corners.mean(axis=1, keepdims=True)
    steps = (
        away[:, :, :1] * paint.gradients[:, None, 0] + away[:, :, 1:] * paint.gradients[:, None, 1]
    )
    found = [tone.toned(paint.colors + steps[:, corner], numbers) for corner in range(3)]
    return np.stack(found, axis=1)


def _through(paint: Paint, at_corners: np.ndarray) -> np.ndarray:
    """Gradients that have given colours at the corners, [N, 2, 3]; none on a line."""
    first, second = _sides(paint)
    area = _doubled_areas(first, second)
    size = np.where(np.abs(area) > 1e-9, area, np.inf)[:, None]
    one, other = at_corners[:, 1] - at_corners[:, 0], at_corners[:, 2] - at_corners[:, 0]
    right = (one * second[:, 1:] - other * first[:, 1:]) / size
    down = (other * first[:, :1] - one * second[:, :1]) / size
    return np.stack([right, down], axis=1)


def _changes(
    paint: Paint,
    tone: Tone,
    numbers: np.ndarray | None,
    slopes: np.ndarray,
    reaches: Sequence[np.ndarray],
) -> np.ndarray:
    """What becomes of changes of colour, told by changed colours on either side of the mean.

    Args:
        paint: The triangles.
        tone: What is done to their colours.
        numbers: Which colours of the palette they become, or None.
        slopes: Changes of colour for one step, [N, S, 3].
        reaches: For each how many steps the triangle is wide, [N].

    Returns:
        The same form.
    """
    found = np.zeros_like(slopes)
    for k, reach in enumerate(reaches):
        size = np.abs(slopes[:, k]).max(axis=1)
        steps = np.minimum(reach, WIDEST / np.maximum(size, 1e-9))[:, None]
        ends = [
            tone.toned(paint.colors + sign * steps * slopes[:, k], numbers) for sign in (1.0, -1.0)
        ]
        found[:, k] = (ends[0] - ends[1]) / (2.0 * np.maximum(steps, 1e-9))
    return found


def _sides(paint: Paint) -> tuple[np.ndarray, np.ndarray]:
    """Corners 1 and 2 of triangles from corner 0 [px], both [N, 2]."""
    corners = paint.corners
    return corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]


def _doubled_areas(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Twice the signed areas of triangles by two sides [px^2], [N]."""
    return np.asarray(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
