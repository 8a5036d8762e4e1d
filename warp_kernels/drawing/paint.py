"""The triangles of a frame as styles look at them, on the host."""

from dataclasses import dataclass

import numpy as np

from warp_kernels.scene.places import FRACTION, hashes_of, to_places
from warp_kernels.scene.stroke_lay import Lay, joined_lay


@dataclass(frozen=True, eq=False)
class Paint:
    """Shapes and colour polynomials of some triangles."""

    colors: np.ndarray
    """Mean colours, within `limits` [code values], [N, 3]."""
    gradients: np.ndarray
    """Change of colour to the right and down, at the centroid [code values / px], [N, 2, 3]."""
    curvatures: np.ndarray | None
    """What quadratic colours add, see `Scene`, [N, 4, 3]; None for others."""
    limits: np.ndarray
    """The lowest and the highest values that may be shown, within 0..255 [code values],
    [N, 2, 3]."""
    corners: np.ndarray
    """Positions of the corners, corner 0 first [px of the picture], [N, 3, 2]."""
    ids: np.ndarray
    """Persistent numbers of the triangles, [N] int64."""
    shares: np.ndarray | None = None
    """How much each belongs to every followed region, 0 to 255, [N, R] uint8; None for R = 0."""
    lay: Lay | None = None
    """How strokes lie on each; None if they are new on all."""

    def of(self, triangles: np.ndarray) -> "Paint":
        """Some of the triangles, by their numbers [M]."""
        return Paint(
            self.colors[triangles],
            self.gradients[triangles],
            None if self.curvatures is None else self.curvatures[triangles],
            self.limits[triangles],
            self.corners[triangles],
            self.ids[triangles],
            None if self.shares is None else self.shares[triangles],
            None if self.lay is None else self.lay.of(triangles),
        )

    @property
    def hashes(self) -> np.ndarray:
        """A number without order for every id, the same on every machine, [N] uint32."""
        return hashes_of(self.ids)


def joined_paint(parts: list[Paint]) -> Paint:
    """Triangles of one colour model and one look, one after the other."""
    curvatures = [part.curvatures for part in parts if part.curvatures is not None]
    shares = [part.shares for part in parts if part.shares is not None]
    lays = [part.lay for part in parts if part.lay is not None]
    return Paint(
        np.concatenate([part.colors for part in parts]),
        np.concatenate([part.gradients for part in parts]),
        np.concatenate(curvatures) if curvatures else None,
        np.concatenate([part.limits for part in parts]),
        np.concatenate([part.corners for part in parts]),
        np.concatenate([part.ids for part in parts]),
        np.concatenate(shares) if shares else None,
        joined_lay(lays) if lays else None,
    )


@dataclass(frozen=True, eq=False)
class Shapes:
    """Where triangles lie and how they are shaped, apart from each other."""

    anchors: np.ndarray
    """Places of the corners 0 [2^-16 px], [N, 2]."""
    sides: np.ndarray
    """Corners 1 and 2 from corner 0 [px], [N, 2, 2]."""
    incircles: np.ndarray
    """Incentre from corner 0 and the inradius [px], [N, 3]."""
    lines: np.ndarray
    """Their sides, as `Scene` has them, [N, 3, 3]."""


def shapes_of(corners: np.ndarray) -> Shapes:
    """Take places and shapes apart; shapes do not change with a move by whole pixels.

    Args:
        corners: Positions [px], [N, 3, 2].
    """
    # long rows: numpy is slow where the last axis is a point
    places = to_places(np.ascontiguousarray(corners.reshape(-1, 6).T)).reshape(3, 2, -1)
    sides = (places[1:] - places[0]) / FRACTION
    first, second = sides
    # the side across from a corner is its weight: sum(weight * corner) / sum(weight)
    across = [_lengths(*side) for side in (second - first, second, first)]
    perimeter = np.maximum(sum(across), 1e-12)
    centres = (across[1] * first + across[2] * second) / perimeter
    radii = np.abs(first[0] * second[1] - first[1] * second[0]) / perimeter
    incircles = np.stack([*centres, radii], axis=1)
    return Shapes(places[0].T, sides.transpose(2, 0, 1), incircles, _lines(first, second))


def _lines(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Sides of triangles of either orientation, [N, 3, 3].

    Args:
        first: Corners 1 from corner 0 [px], [2, N].
        second: Corners 2 from there [px], [2, N].
    """
    x, y = np.stack([np.zeros_like(first), first, second], axis=1)
    a, b = y - y[[1, 2, 0]], x[[1, 2, 0]] - x
    length = np.maximum(_lengths(a, b), 1e-12)
    a, b = a / length, b / length
    # the third corner lies inside of the side between the other two
    inside = (x[[2, 0, 1]] - x) * a + (y[[2, 0, 1]] - y) * b
    sign = np.where(inside < 0, -1.0, 1.0)
    a, b = sign * a, sign * b
    return np.stack([a, b, -(a * x + b * y)], axis=2).swapaxes(0, 1)


def _lengths(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Lengths of vectors by their components."""
    return np.sqrt(x * x + y * y)
