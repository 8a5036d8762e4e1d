"""Colours of a followed picture that do not tremble, and new triangles that come in two steps.

The mean of a triangle changes a little in every frame even where the picture only moves: its edges
fall on other fractions of pixels. Such changes save next to nothing and are seen. What a flip or a
split makes differs from what lay there, all at once.
"""

import numpy as np

from stages.mesh import Mesh
from stages.motion.beneath import beneath
from stages.motion.correspondence import kept_triangles
from stages.snapshot import Snapshot

ALLOWANCE = 0.0025
"""Part of its energy that a triangle gives for a colour nearer to that of the frame before: four
times as much does hardly more."""
WELCOME = 0.02
"""The same of a triangle that is new, for one nearer to what lay there; in the frame after it has
its own."""
PARTS = 4
"""What lay where a new triangle lies is looked at in so many times so many places."""
LEAST_SEEN = 0.5
"""Where less than this part of a new triangle lies on others of the frame before it has no colour
to keep to."""


def steadied(
    before: Snapshot,
    mesh: Mesh,
    counts: np.ndarray,
    coefficients: np.ndarray,
    energies: np.ndarray,
    calm: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Colours as near to those of the frame before as they may be for next to nothing.

    Args:
        before: The frame before.
        mesh: What its mesh has become.
        counts: Pixels of each triangle, [T].
        coefficients: The best colours, as in a snapshot, [T, 3, K].
        energies: What they leave [code value^2 px], [T].
        calm: How calm it is around each triangle, from 0 where the picture boils to 1, [T]; None
            for calm everywhere.

    Returns:
        Coefficients and energies; all keep the best colours where a triangle has more than one.
    """
    if not before.coefficients.shape[2] == coefficients.shape[2] == 1:
        return coefficients, energies
    kept = kept_triangles(before.mesh, mesh)
    had = before.coefficients[kept]
    born = np.flatnonzero(kept < 0)
    if len(born):
        seen, had[born] = _colors_beneath(before, mesh, kept, born)
        had[born[~seen]] = coefficients[born[~seen]]
    back = had - coefficients
    # a colour that is d away from the mean costs half of d^2 for every pixel
    costs = 0.5 * counts * np.square(back).sum(axis=(1, 2))
    allowed = np.where(kept < 0, WELCOME, ALLOWANCE) * np.maximum(energies, 0.0)
    if calm is not None:
        allowed *= calm
    shares = np.minimum(1.0, np.sqrt(allowed / np.maximum(costs, 1e-12)))
    return coefficients + shares[:, None, None] * back, energies + shares**2 * costs


def _colors_beneath(
    before: Snapshot, mesh: Mesh, kept: np.ndarray, born: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mean colours of what lay where new triangles lie.

    Args:
        before: The frame before.
        mesh: The mesh with the new triangles.
        kept: Numbers of its triangles in the mesh before, or -1, [T].
        born: Numbers of the new ones, [B].

    Returns:
        Whether enough is known of each, [B] bool, and the colours, [B, 3, 1].
    """
    going = np.ones(before.mesh.triangle_count, dtype=bool)
    going[kept[kept >= 0]] = False  # a new one lies where others were, and nowhere else
    owners, links, shares = beneath(before.mesh, mesh, born, PARTS, np.flatnonzero(going))
    total = np.bincount(owners, weights=shares, minlength=len(born))
    colors = np.zeros((len(born), before.coefficients.shape[1], 1))
    np.add.at(colors, owners, shares[:, None, None] * before.coefficients[links])
    return total >= LEAST_SEEN, colors / np.maximum(total, 1e-9)[:, None, None]
