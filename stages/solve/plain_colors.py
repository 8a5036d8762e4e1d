"""Triangles of one colour that take the colour of what they lie on.

The mean of a triangle that reaches over a border by a little is a third colour: faint rays beside
letters on white, grey corners in black ones. The pixels beyond the border are few, most of them are
blends themselves, and what is drawn there is blended with what lies next to them anyway; so the
colour of the large part is no worse for the picture, and nobody sees the triangle.
"""

import numpy as np

from warp_kernels.color_model import CHANNELS
from warp_kernels.energy.plain_colors import PlainColors

FEW = 0.1, 0.3
"""Up to the first part of its pixels may be others for a triangle to take the colour of the rest;
from the second one on it keeps its mean."""
ALIKE = 2.0, 4.0
"""The same for the standard deviation of the rest [code values]: where a picture is not plain every
pixel counts."""
LEAST_SPREAD = 0.5
"""Where all pixels differ less than this their mean is as good as any [code values]."""


def plainer(
    looker: PlainColors,
    counts: np.ndarray,
    means: np.ndarray,
    left: np.ndarray,
    colors: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Colours of the larger parts of triangles that lie on plain ground, and what they leave.

    Args:
        looker: Looks at the mesh and the picture.
        counts: Pixels of each triangle, [T].
        means: The best colours, as in a snapshot, of one term, [T, 3, 1].
        left: What they leave [code value^2 px], [T].
        colors: What triangles show that keep their own, [T, 3, 1].

    Returns:
        Coefficients and energies.
    """
    asked = left > 0.5 * CHANNELS * LEAST_SPREAD**2 * counts
    found = looker.measure(np.where(asked, counts, 0), means[:, :, 0], left)
    others = 1.0 - found.counts / np.maximum(counts, 1)
    shares = _falling(others, *FEW) * _falling(found.spreads, *ALIKE)
    shares[found.counts == 0] = 0.0
    colors = colors + shares[:, None, None] * (found.colors[:, :, None] - colors)
    # a colour that is d away from the mean costs half of d^2 for every pixel
    costs = 0.5 * counts * np.square(colors - means).sum(axis=(1, 2))
    return colors, left + costs


def _falling(values: np.ndarray, begin: float, end: float) -> np.ndarray:
    """1 up to one value and 0 from another one on."""
    return np.clip((end - values) / (end - begin), 0.0, 1.0)
