"""Choose another base edge for a triangle."""

from dataclasses import replace

import numpy as np

from stages.mesh import Mesh


def turn_base_edge(mesh: Mesh, triangles: np.ndarray) -> Mesh:
    """Make the next edge of each triangle its base edge: rows (a, b, c) become (b, c, a).

    Ids stay: the triangle is the same, only its texture turns.

    Args:
        mesh: The mesh to edit.
        triangles: Triangle numbers, shape [N], without repetition.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.5.
    """
    rows = mesh.triangles.copy()
    rows[triangles] = rows[triangles][:, [1, 2, 0]]
    return replace(mesh, triangles=rows)
