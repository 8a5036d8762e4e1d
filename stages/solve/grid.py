"""The numbers that a solution may have: so coarse that nobody sees it, so few that they pack well.

What a picture becomes is rounded once, when it is solved. So what is drawn at once, what a track
stores and what is read from it are the same to the bit, in a third of the bytes.

Every function here adds, multiplies and divides element by element in double precision and nothing
else, so all machines agree.
"""

import numpy as np

from stages.mesh import Mesh
from warp_kernels.color_model import CHANNELS, ColorModel

PLACES = 1 << 16
"""Steps of a position in a pixel: 256 of them are what decides whether a pixel is covered."""
SHADES = 63
"""Steps of a colour in a code value: no place of a triangle is off by more than half of one in a
linear colour. An odd number of them has whole code values among them and no halves, of which no two
ways to round to code values would have to agree."""
Parts = tuple[np.ndarray, ...]
"""Numbers of the triangles, each [T]."""
DROPPED = 7
"""Last bits of a single-precision energy that are zero: 2^-17 of its value at most."""


def rounded_places(mesh: Mesh) -> Mesh:
    """A mesh with vertices on the grid; itself if that would fold a triangle.

    Args:
        mesh: A valid mesh.
    """
    places = np.rint(mesh.vertices * PLACES) / PLACES + 0.0  # no zero has a sign
    if np.array_equal(places, mesh.vertices):
        return mesh
    moved = mesh.moved(places)
    return moved if moved.areas.min() > 0 else mesh


def rounded_colors(mesh: Mesh, model: ColorModel, coefficients: np.ndarray) -> np.ndarray:
    """Colours whose values at the nodes of their triangles are on the grid.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].
    """
    return colors_through(mesh, model, shades(mesh, model, coefficients))


def rounded_energies(energies: np.ndarray) -> np.ndarray:
    """Energies in as many digits as anything depends on.

    Args:
        energies: At least 0 and below 1e38 [code value^2 px], [T].
    """
    bits = energies.astype(np.float32).view(np.uint32)
    half = np.uint32(1 << (DROPPED - 1))
    return ((bits + half) >> DROPPED << DROPPED).view(np.float32).astype(np.float64)


def shades(mesh: Mesh, model: ColorModel, coefficients: np.ndarray) -> np.ndarray:
    """What colours are at the nodes of their triangles, rounded [code values / SHADES].

    As many numbers as a colour has terms: at the corners, and of quadratic colours also in the
    middles of the sides from corner 0 to 1, 1 to 2 and 2 to 0.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].

    Returns:
        Whole numbers, [K, 3, T] float64.
    """
    terms = np.ascontiguousarray(coefficients.transpose(2, 1, 0))
    if model.degree == 0:
        return np.rint(terms * SHADES) + 0.0  # no zero has a sign
    x, y = mesh.corner_columns
    if model.degree == 2:
        x, y = (np.concatenate([n, 0.5 * (n + n[[1, 2, 0]])]) for n in (x, y))
    powers = {(1, 0): x, (0, 1): y, (2, 0): x * x, (1, 1): x * y, (0, 2): y * y}
    values = np.broadcast_to(terms[0], terms.shape)
    for term, exponents in enumerate(model.exponents[1:], 1):
        values = values + powers[exponents][:, None] * terms[term]
    return np.rint(values * SHADES) + 0.0


def colors_through(mesh: Mesh, model: ColorModel, values: np.ndarray) -> np.ndarray:
    """The colours that have some values at the nodes of their triangles.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        values: As `shades` gives them, [K, 3, T].

    Returns:
        Coefficients as in a snapshot, [T, 3, K].
    """
    found = np.empty((mesh.triangle_count, CHANNELS, model.term_count))
    nodes = Nodes(mesh, model)
    for channel in range(CHANNELS):  # a channel of many triangles is as much as caches hold
        nodes.fit(values[:, channel], found[:, channel])
    return found


def value_range(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whole code values between which colours lie at the nodes of their triangles.

    Those of linear colours lie between them everywhere.

    Args:
        values: As `shades` gives them, [K, ...].

    Returns:
        Lowest and highest, from 0 to 255, each [...].
    """
    lowest, highest = values.min(axis=0), values.max(axis=0)
    bounds = np.floor(lowest / SHADES), np.ceil(highest / SHADES)
    return np.clip(bounds[0], 0.0, 255.0), np.clip(bounds[1], 0.0, 255.0)


def tightened(model: ColorModel, values: np.ndarray, limits: np.ndarray) -> np.ndarray:
    """Limits that say no more than they must: what a triangle does not reach needs none.

    Args:
        model: Fixes the terms; only linear colours are known to stay between their nodes.
        values: As `shades` gives them, [K, 3, T].
        limits: As in a snapshot, [T, 2, 3].

    Returns:
        Limits between which the triangles look the same, [T, 2, 3] uint8.
    """
    if model.degree != 1:
        return limits
    lowest, highest = (bound.T for bound in value_range(values))
    low, high = limits[:, 0], limits[:, 1]
    bounds = np.maximum(low, np.minimum(lowest, high)), np.minimum(high, np.maximum(highest, low))
    return np.stack(bounds, axis=1).astype(np.uint8)


class Nodes:
    """Turns values at the nodes of triangles into coefficients, one channel at a time.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
    """

    def __init__(self, mesh: Mesh, model: ColorModel) -> None:
        self._degree = model.degree
        if model.degree:
            x, y = mesh.corner_columns
            self._origin = x[0], y[0]
            self._frame = _frame(x, y)

    def fit(self, values: np.ndarray, out: np.ndarray) -> None:
        """Find the coefficients of one channel.

        Args:
            values: As `shades` gives them, [K, T].
            out: Receives them as a snapshot has them, [T, K].
        """
        terms: Parts = (values[0],)
        if self._degree:
            polynomial = _linear if self._degree == 1 else _quadratic
            terms = polynomial(values, self._frame, self._origin)
        for term, numbers in enumerate(terms):
            np.divide(numbers, SHADES, out=out[:, term])


def _frame(x: np.ndarray, y: np.ndarray) -> Parts:
    """How a position, from corner 0 on, is s of side 0-1 and t of side 0-2.

    Args:
        x: Of corners [px], [3, T].
        y: Of corners [px], [3, T].

    Returns:
        sx, sy, tx, ty with s = sx x + sy y and t = tx x + ty y, each [T].
    """
    e1x, e1y, e2x, e2y = x[1] - x[0], y[1] - y[0], x[2] - x[0], y[2] - y[0]
    twice = e1x * e2y - e2x * e1y
    return e2y / twice, -e2x / twice, -e1y / twice, e1x / twice


def _linear(values: np.ndarray, frame: Parts, origin: Parts) -> Parts:
    """Coefficients of 1, x, y of what has some values at the corners, each [T]."""
    (sx, sy, tx, ty), (x0, y0) = frame, origin
    a, b = values[1] - values[0], values[2] - values[0]
    gx, gy = a * sx + b * tx, a * sy + b * ty
    return values[0] - gx * x0 - gy * y0, gx, gy


def _quadratic(values: np.ndarray, frame: Parts, origin: Parts) -> Parts:
    """Coefficients of 1, x, y, x^2, x y, y^2, by the middles of the sides as well, each [T]."""
    (sx, sy, tx, ty), (x0, y0) = frame, origin
    v0, v1, v2, m01, m12, m20 = values
    # of s, t, s^2, s t and t^2
    a, c = 4.0 * m01 - 3.0 * v0 - v1, 2.0 * (v0 + v1) - 4.0 * m01
    b, e = 4.0 * m20 - 3.0 * v0 - v2, 2.0 * (v0 + v2) - 4.0 * m20
    d = 4.0 * (m12 - v0) - 2.0 * (a + b) - c - e
    gx, gy = a * sx + b * tx, a * sy + b * ty
    xx = c * sx * sx + d * sx * tx + e * tx * tx
    xy = 2.0 * (c * sx * sy + e * tx * ty) + d * (sx * ty + sy * tx)
    yy = c * sy * sy + d * sy * ty + e * ty * ty
    one = values[0] - gx * x0 - gy * y0 + xx * x0 * x0 + xy * x0 * y0 + yy * y0 * y0
    return one, gx - 2.0 * xx * x0 - xy * y0, gy - 2.0 * yy * y0 - xy * x0, xx, xy, yy
