"""Spend triangles where the error is large: when to split, while `edits` knows how."""

import numpy as np

from stages.edits import split_triangles
from stages.mesh import Mesh

SMALLEST_AREA = 4.0
"""Triangles below this area are not split [px^2]: their parts would hold a pixel or none."""


def split_worst(
    mesh: Mesh, energies: np.ndarray, *, count: int, threshold: float | None = None
) -> Mesh:
    """Split the worst triangles at their centroids until there are `count`.

    Args:
        mesh: The mesh.
        energies: E(T) [code value^2 px], [T].
        count: Number of triangles to reach, give or take one: a split adds two.
        threshold: Only triangles with sqrt(E(T) / |I|) above this are split [code values], where
            |I| is the number of pixels of the picture; None for all with any error.

    Returns:
        The refined mesh, or `mesh` itself if there is nothing to split.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.4.
    """
    wanted = (count - mesh.triangle_count + 1) // 2
    if wanted <= 0:
        return mesh
    floor = 0.0 if threshold is None else threshold**2 * mesh.width * mesh.height
    eligible = (energies > floor) & (mesh.areas > SMALLEST_AREA)
    worst = np.argsort(-energies, kind="stable")
    worst = worst[eligible[worst]][:wanted]
    return split_triangles(mesh, worst) if len(worst) else mesh
