"""Colours of a followed picture that do not tremble.

The mean of a triangle changes a little in every frame even where the picture only moves: its edges
fall on other fractions of pixels. Such changes save next to nothing and are seen.
"""

import numpy as np

from stages.mesh import Mesh
from stages.motion.correspondence import kept_rows
from stages.snapshot import Snapshot

ALLOWANCE = 0.001
"""Part of its energy that a triangle gives for a colour nearer to that of the frame before: ten
times as much does hardly more."""


def steadied(
    before: Snapshot,
    mesh: Mesh,
    counts: np.ndarray,
    coefficients: np.ndarray,
    energies: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Colours as near to those of the frame before as they may be for next to nothing.

    Args:
        before: The frame before.
        mesh: What its mesh has become.
        counts: Pixels of each triangle, [T].
        coefficients: The best colours, as in a snapshot, [T, 3, K].
        energies: What they leave [code value^2 px], [T].

    Returns:
        Coefficients and energies; new triangles keep the best colours, and so do all where one has
        more than one colour.
    """
    if not before.coefficients.shape[2] == coefficients.shape[2] == 1:
        return coefficients, energies
    rows = kept_rows(before.mesh.triangle_ids, mesh.triangle_ids)
    back = np.where(rows[:, None, None] >= 0, before.coefficients[rows] - coefficients, 0.0)
    # a colour that is d away from the mean costs half of d^2 for every pixel
    costs = 0.5 * counts * np.square(back).sum(axis=(1, 2))
    allowed = ALLOWANCE * np.maximum(energies, 0.0)
    shares = np.minimum(1.0, np.sqrt(allowed / np.maximum(costs, 1e-12)))
    return coefficients + shares[:, None, None] * back, energies + shares**2 * costs
