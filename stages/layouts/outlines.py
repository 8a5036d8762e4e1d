"""The layout of edges: points along the outlines, a few between them."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.layouts.radial import check_shares

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

LINES = 512
"""Pictures are reduced to this many pixels on the short side."""
BLUR = 1.2
"""Standard deviation of the blur before slopes are measured [px of the reduced picture]."""
WEAKEST = 0.06
"""Slopes below this part of the steepest are no outlines."""
STEEPEST = 0.99
"""The steepest one is that below which this part of all outlines lies."""
ALONG = 0.5
"""Points of the strongest outlines are this part of the even spacing apart."""
FAINT = 2.0
"""Those of the weakest are so many times as far apart."""


@dataclass(frozen=True)
class Outlines:
    """Points on the outlines of what is seen, the denser the stronger, and some by lot between.

    Raises:
        OptionError: If a number is out of its range.
    """

    share: float = field(default=0.75)
    """Part of the points that lies on outlines, as far as there are any [0..1]."""

    def __post_init__(self) -> None:
        check_shares(self, "share")

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Find outlines, put points on them, and triangulate these.

        Args:
            pixels: The picture, shape [H, W, 3] uint8.
            triangle_count: Wanted number of triangles; odd ones are missed by one at most.
            rng: Source of the draws between outlines.
        """
        import numpy as np

        from stages.layouts.even_points import (
            MARGIN,
            apart,
            border_points,
            bounded_count,
            delaunay_mesh,
            even_spacing,
        )
        from stages.layouts.poisson import scattered

        height, width = pixels.shape[:2]
        size = (width, height)
        count = bounded_count(pixels, triangle_count)
        spacing = even_spacing(width, height, count)
        border = border_points(width, height, 1.3 * spacing)
        inner = max(0, (count + 2 - len(border) + 1) // 2)
        points = border
        spots, strengths = _outlines(pixels)
        margin = MARGIN * min(ALONG * spacing, 0.5 * min(size))
        keeps = ((spots > margin) & (spots < np.array(size) - margin)).all(axis=1)
        spots, strengths = spots[keeps], strengths[keeps]
        wanted = len(border) + round(self.share * inner)
        for level in np.geomspace(1.0, WEAKEST, 6):  # strong outlines first, and densest
            distance = spacing * ALONG * FAINT ** (np.log(level) / np.log(WEAKEST))
            on_level = spots[strengths >= level]
            near = np.concatenate([points, on_level])
            points = apart(near, distance, fixed=len(points))[:wanted]
        points = scattered(points, len(border) + inner - len(points), spacing, size, rng)
        return delaunay_mesh(points, width, height)


def _outlines(pixels: "np.ndarray") -> "tuple[np.ndarray, np.ndarray]":
    """Where outlines run, the strongest first.

    Args:
        pixels: The picture, [H, W, 3] uint8.

    Returns:
        Positions [px], [N, 2], and strengths, 1 for strong ones and less for weaker, [N].
    """
    import cv2
    import numpy as np

    height, width = pixels.shape[:2]
    scale = min(1.0, LINES / min(height, width))
    size = (max(1, round(scale * width)), max(1, round(scale * height)))
    small = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
    smooth = cv2.GaussianBlur(small, (0, 0), BLUR).astype(np.float32)
    across, down = (cv2.Sobel(smooth, cv2.CV_32F, *way, scale=1 / 8) for way in ((1, 0), (0, 1)))
    lengths = across**2 + down**2
    channel = lengths.argmax(axis=2)[..., None]  # the channel that shows an outline best
    slope = np.sqrt(np.take_along_axis(lengths, channel, 2)[..., 0])
    ways = [np.take_along_axis(way, channel, 2)[..., 0] for way in (across, down)]
    rows, columns = np.nonzero(_is_ridge(slope, *ways) & (slope > 0.5))
    found = slope[rows, columns]
    if not len(found):
        return np.zeros((0, 2)), np.zeros(0)
    strengths = np.minimum(found / np.quantile(found, STEEPEST), 1.0)
    order = np.argsort(-found, kind="stable")
    order = order[strengths[order] >= WEAKEST]
    spots = np.stack([columns + 0.5, rows + 0.5], axis=1) * (width / size[0], height / size[1])
    return spots[order], strengths[order].astype(np.float64)


def _is_ridge(slope: "np.ndarray", across: "np.ndarray", down: "np.ndarray") -> "np.ndarray":
    """Where a slope is steeper than on both sides of the outline, [H, W] bool."""
    import numpy as np

    padded = np.pad(slope, 1)
    unit = np.maximum(slope, 1e-9)
    right = np.rint(across / unit).astype(np.int64)
    below = np.rint(down / unit).astype(np.int64)
    rows, columns = np.indices(slope.shape) + 1
    before = padded[rows - below, columns - right]
    after = padded[rows + below, columns + right]
    ridge: np.ndarray = (slope > before) & (slope >= after)
    return ridge
