"""Where the material of a mesh lay in a neighbouring frame."""

import numpy as np

from stages.mesh import Mesh
from stages.motion.advect import sliding
from stages.motion.correspondence import kept_vertices


def earlier_vertices(before: Mesh, mesh: Mesh) -> np.ndarray:
    """Where the vertices of a mesh lay one frame earlier; new ones move as those around them do.

    Args:
        before: The mesh of that frame.
        mesh: The mesh.

    Returns:
        Positions [px], shape [V, 2].
    """
    places = kept_vertices(before, mesh)
    known = places >= 0
    steps = np.zeros((mesh.vertex_count, 2))
    steps[known] = before.vertices[places[known]] - mesh.vertices[known]
    tails, heads = mesh.edge_vertices.T
    ends = np.concatenate([tails, heads]), np.concatenate([heads, tails])
    told = known.copy()
    while not told.all():
        asks = ~told[ends[0]] & told[ends[1]]
        asking, told_by = ends[0][asks], ends[1][asks]
        counts = np.bincount(asking, minlength=mesh.vertex_count)
        if not len(asking):
            break  # nothing is left of the frame before
        for axis in range(2):
            sums = np.bincount(asking, steps[told_by, axis], mesh.vertex_count)
            steps[counts > 0, axis] = sums[counts > 0] / counts[counts > 0]
        told |= counts > 0
    earlier = mesh.vertices + sliding(mesh, steps)
    earlier[known] = before.vertices[places[known]]
    return earlier
