"""Delaunay triangles over vertices drawn from a map of importance."""

import cv2
import numpy as np

from stages.layouts.delaunay import apart_from, delaunay_mesh, earlier_ones
from stages.mesh import Mesh
from warp_kernels.errors import OptionError

SALIENCY_LINES = 512
"""Pictures are reduced to this many pixels on the short side for the saliency."""
MAP_ROUNDS = 8
"""Rounds of draws from the map; what still finds no room is drawn evenly."""
ROUNDS = 40
"""All rounds of draws, so that a picture without room for all vertices ends them too."""
CLOSEST = 0.5
"""Vertices never come closer than this [px]."""


def drawn_mesh(
    pixels: np.ndarray,
    triangle_count: int,
    rng: np.random.Generator,
    importance_map: np.ndarray | None,
    even_share: float,
    border_density: float,
) -> Mesh:
    """Draw the vertices and triangulate them; see `Importance`."""
    height, width = pixels.shape[:2]
    count = max(2, min(triangle_count, width * height))
    density = _density(pixels, importance_map, even_share)
    even_spacing = np.sqrt(2.0 * width * height / count)
    border = _border_points(density, count, border_density / even_spacing)
    # Every triangulation of I inner and B border vertices has 2 I + B - 2 triangles.
    inner_count = (count + 2 - len(border)) // 2
    points = _inner_points(density, border, inner_count, 0.4 * even_spacing, rng)
    return delaunay_mesh(border, points[len(border) :], width, height)


def _density(
    pixels: np.ndarray, importance_map: np.ndarray | None, even_share: float
) -> np.ndarray:
    """Relative density of vertices, shape [H, W], of mean 1."""
    height, width = pixels.shape[:2]
    if importance_map is None:
        importance = _saliency(pixels)
    else:
        importance = np.asarray(importance_map, dtype=np.float64)
        if not (np.isfinite(importance).all() and importance.min() >= 0 < importance.max()):
            raise OptionError(
                f"the importance map has values {importance.min()}..{importance.max()}; "
                "they must be finite, not negative, and somewhere above 0: paint it lighter "
                "where triangles are to be small"
            )
        # The artist's map is obeyed to the letter.
        even_share = 0.0
    density = cv2.resize(importance, (width, height), interpolation=cv2.INTER_AREA)
    if not density.any():
        return np.ones((height, width))
    return even_share + (1.0 - even_share) * density / density.mean()


def _saliency(pixels: np.ndarray) -> np.ndarray:
    """Visual importance by contrast between centre and surround, shape [h, w], [0..1].

    OpenCV's fine-grained estimator follows the outlines; the spectral residual one marks a few
    blurred spots, too coarse to place triangles.
    """
    scale = min(1.0, SALIENCY_LINES / min(pixels.shape[:2]))
    size = [max(1, round(scale * side)) for side in (pixels.shape[1], pixels.shape[0])]
    grey = cv2.resize(cv2.cvtColor(pixels, cv2.COLOR_RGB2GRAY), size, interpolation=cv2.INTER_AREA)
    _, saliency = cv2.saliency.StaticSaliencyFineGrained.create().computeSaliency(grey)
    return np.nan_to_num(saliency.astype(np.float64))


def _border_points(density: np.ndarray, count: int, per_pixel: float) -> np.ndarray:
    """The corners, and vertices along the four sides where the density asks for them.

    Args:
        density: Relative density of vertices, shape [H, W].
        count: Wanted number of triangles; the number of points is even or odd as it is.
        per_pixel: Vertices per pixel of border [1/px].

    Returns:
        Points [px], shape [B, 2], B - count even, B <= count + 2.
    """
    height, width = density.shape
    total = min(round(2 * (width + height) * per_pixel), count - 2)
    total += (count - total) % 2
    ends = total * np.cumsum([0, width, height, width, height]) / (2 * (width + height))
    side_counts = np.diff(np.round(ends)).astype(np.int64)
    points = [np.array([[0, 0], [width, 0], [0, height], [width, height]], dtype=np.float64)]
    for side_count, line, axis, place in (
        (side_counts[0], density[0], 0, 0),
        (side_counts[1], density[:, -1], 1, width),
        (side_counts[2], density[-1], 0, height),
        (side_counts[3], density[:, 0], 1, 0),
    ):
        side = np.full((side_count, 2), place, dtype=np.float64)
        shares = (np.arange(side_count) + 0.5) / max(side_count, 1)
        side[:, axis] = _inverse_cdf(_half_even(line), shares)
        points.append(side)
    return np.concatenate(points)


def _half_even(line: np.ndarray) -> np.ndarray:
    """A density whose half is spread evenly: border vertices must not bunch, shape [n]."""
    return line / max(line.mean(), 1e-12) + 1.0


def _inverse_cdf(density: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Where a piecewise constant density reaches given shares of its sum [px, N]."""
    sums = np.concatenate([[0.0], np.cumsum(density)])
    return np.interp(shares, sums / sums[-1], np.arange(len(sums)))


def _inner_points(
    density: np.ndarray,
    border: np.ndarray,
    count: int,
    spacing: float,
    rng: np.random.Generator,
) -> np.ndarray:
    """Add inner points that keep a distance, which shrinks from round to round.

    Args:
        density: Relative density of vertices, shape [H, W].
        border: Points on the border [px], shape [B, 2].
        count: Wanted number of inner points.
        spacing: Distance kept in the first round [px].
        rng: Source of the draws.

    Returns:
        The border points, then the inner ones [px], shape [B + count or fewer, 2].
    """
    height, width = density.shape
    size = np.array([width, height])
    points = border
    for attempt in range(ROUNDS):
        missing = len(border) + count - len(points)
        if missing <= 0:
            break
        weights = density if attempt < MAP_ROUNDS else np.ones_like(density)
        drawn = _draw(weights, 2 * missing, rng)
        margin = min(spacing / 2, 0.25 * size.min())
        drawn = drawn[((drawn > margin) & (drawn < size - margin)).all(axis=1)]
        drawn = drawn[apart_from(drawn, points, spacing)]
        drawn = drawn[earlier_ones(drawn, spacing)]
        points = np.concatenate([points, drawn[:missing]])
        spacing = max(0.8 * spacing, CLOSEST)
    return points


def _draw(density: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Draw points by the inverse CDF in two dimensions: a row, then a place along it.

    Args:
        density: Weight of every pixel, shape [H, W], with a sum above 0.
        count: Number of points N.
        rng: Source of the draws.

    Returns:
        Points [px], shape [N, 2].
    """
    down, along = rng.random((2, count))
    y = _inverse_cdf(density.sum(axis=1), down)
    rows = np.minimum(y.astype(np.int64), len(density) - 1)
    sums = np.cumsum(density, axis=1)
    # Rows of their own scale, end to end, let one search serve all: row r covers r..r + 1.
    sums = sums / np.maximum(sums[:, -1:], 1e-300) + np.arange(len(density))[:, None]
    ends = np.concatenate([[0.0], sums.ravel()])
    return np.stack([np.interp(rows + along, ends, np.arange(len(ends))) % density.shape[1], y], 1)
