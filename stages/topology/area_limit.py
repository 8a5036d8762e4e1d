"""Divide the triangles that are larger than an artist wants them."""

import numpy as np

from stages.edits import independent_flips, split_edges
from stages.mesh import Mesh


def divide_large(mesh: Mesh, largest_area: float) -> Mesh:
    """Halve the longest edges of large triangles until none is left.

    Args:
        mesh: A valid mesh.
        largest_area: Area that no triangle may exceed [px^2].

    Returns:
        A valid mesh; the same object if nothing is to be done.
    """
    while True:
        large = np.flatnonzero(mesh.areas > largest_area)
        if not len(large):
            return mesh
        large = large[np.argsort(-mesh.areas[large], kind="stable")]
        corners = mesh.vertices[mesh.triangles[large]]
        lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        longest = 3 * large + lengths.argmax(axis=1)
        # every round halves at least the largest triangle, so the rounds end
        mesh = split_edges(mesh, longest[independent_flips(mesh, longest)])
