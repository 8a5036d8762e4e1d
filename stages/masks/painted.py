"""Areas of a picture as a mask."""

from collections.abc import Iterable

import numpy as np

from stages.masks.area import Area

WHITE = 255
FURTHEST = 1e6
"""What a polygon has beyond this counts as lying there [px]."""


def painted(areas: Iterable[Area], size: tuple[int, int]) -> np.ndarray:
    """The pixels whose centres lie in any of some areas.

    Args:
        areas: Parts of the picture.
        size: Its width and height [px].

    Returns:
        White there, black elsewhere, [H, W] uint8.
    """
    width, height = size
    inside = np.zeros((height, width), dtype=bool)
    for area in areas:
        inside |= _in_polygon(area.polygon, size) if area.polygon else _in_disc(area, size)
    return np.where(inside, WHITE, 0).astype(np.uint8)


def _in_disc(area: Area, size: tuple[int, int]) -> np.ndarray:
    """Pixels whose centres lie in a disc, [H, W] bool."""
    x, y = (np.arange(side) + 0.5 - centre for side, centre in zip(size, area.at, strict=True))
    inside: np.ndarray = x**2 + y[:, None] ** 2 <= area.radius**2
    return inside


def _in_polygon(polygon: tuple[tuple[float, float], ...], size: tuple[int, int]) -> np.ndarray:
    """Pixels whose centres lie in a polygon, [H, W] bool."""
    begins = np.clip(np.array(polygon, dtype=np.float64), -FURTHEST, FURTHEST)
    return within_sides(begins, np.roll(begins, -1, axis=0), size)


def within_sides(begins: np.ndarray, ends: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Pixels whose centres have an odd number of sides to their left in their row.

    Of the sides of polygons that touch without lying over each other, such as triangles of a mesh,
    these are the pixels in any of them: a side of two polygons counts twice.

    Args:
        begins: Where sides begin [px], [N, 2].
        ends: Where they end [px], [N, 2].
        size: Width and height of the picture [px].

    Returns:
        Whether each does, [H, W] bool.
    """
    width, height = size
    falls = (begins[:, 1] <= ends[:, 1])[:, None]  # a side of two polygons is cut in one place
    upper, lower = np.where(falls, begins, ends), np.where(falls, ends, begins)
    first, beyond = (
        np.clip(np.ceil(y - 0.5), 0, height).astype(np.int64) for y in (upper[:, 1], lower[:, 1])
    )
    counts = beyond - first
    sides = np.repeat(np.arange(len(begins)), counts)
    rows = np.arange(counts.sum()) - np.repeat(counts.cumsum() - counts, counts) + first[sides]
    (x0, y0), (x1, y1) = upper[sides].T, lower[sides].T
    crossings = x0 + (rows + 0.5 - y0) * (x1 - x0) / (y1 - y0)
    columns = np.clip(np.ceil(crossings - 0.5), 0, width).astype(np.int64)
    switches = np.zeros((height, width + 1), dtype=np.int64)
    np.add.at(switches, (rows, columns), 1)
    inside: np.ndarray = switches.cumsum(axis=1)[:, :width] % 2 == 1
    return inside
