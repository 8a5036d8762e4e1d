"""How the energy changes with a vertex: Eqs. 7-9 and 11, vertex by vertex."""

import numpy as np

from stages.mesh import Mesh


def triangle_gradient(energies: np.ndarray, corner: int, delta: float = 1.0) -> np.ndarray:
    """Central difference of one triangle's energy in the position of a corner, Eq. 11.

    Args:
        energies: E of the thirteen variants [code value^2 px], [13].
        corner: 0, 1 or 2.
        delta: Displacement [px].
    """
    right, left, down, up = energies[1 + 4 * corner : 5 + 4 * corner]
    return np.array([right - left, down - up]) / (2.0 * delta)


def ring(mesh: Mesh, vertex: int) -> list[int]:
    """The vertices connected to a vertex by an edge, Eq. 8."""
    touching = mesh.triangles[(mesh.triangles == vertex).any(axis=1)]
    return sorted(set(touching.ravel().tolist()) - {vertex})


def umbrella_gradient(mesh: Mesh, vertex: int) -> np.ndarray:
    """Derivative of Eq. 9: from the mean of the ring to the vertex [px]."""
    return mesh.vertices[vertex] - mesh.vertices[ring(mesh, vertex)].mean(axis=0)


def vertex_gradient(mesh: Mesh, energies: np.ndarray, vertex: int, regularity: float) -> np.ndarray:
    """Derivative of Eq. 7 in the position of a vertex.

    Args:
        mesh: The mesh.
        energies: E of all variants of all triangles, [T, 13].
        vertex: Which vertex.
        regularity: lambda [code value^2].
    """
    total = regularity * umbrella_gradient(mesh, vertex)
    for triangle, corner in np.argwhere(mesh.triangles == vertex):
        total += triangle_gradient(energies[triangle], corner) / 3.0
    return total
