"""Carry a mesh from one frame to the next along the flow."""

import numpy as np

from stages.flows.field import FlowField
from stages.mesh import Mesh, heights_of

LOWEST = 0.25
"""The flow may thin a triangle down to this height [px]; a lower one it does not thin further."""
HALVINGS = 6
"""A vertex that still folds a triangle after this many halvings of its step stays behind."""


def advect(mesh: Mesh, flow: FlowField) -> Mesh:
    """Move every vertex by the motion of the picture under it.

    Border vertices slide along their border, corners stay. Where a triangle would fold or
    become too thin, the steps of its vertices are halved until it does not.

    Args:
        mesh: A valid mesh.
        flow: Motion from the mesh's frame to the next.

    Returns:
        The same triangles, valid again; ids and rows are kept.

    Source: the paper starts a frame from the last one's mesh (Lawonn & Guenther, Stylized Image
        Triangulation, 2018, Sec. 6.3).
    Deviation: it does not move that mesh; the flow lets vertices follow fast motion.
    """
    return mesh.moved(mesh.vertices + unfolded(mesh, sliding(mesh, flow.at(mesh.vertices))))


def sliding(mesh: Mesh, steps: np.ndarray) -> np.ndarray:
    """Steps that keep vertices in the domain and border vertices on their border.

    Args:
        mesh: A valid mesh.
        steps: Motion of every vertex [px], shape [V, 2].

    Returns:
        Steps [px], shape [V, 2].
    """
    fixed = np.stack([mesh.on_left_right, mesh.on_top_bottom], axis=1)
    goals = np.clip(mesh.vertices + steps, 0, (mesh.width, mesh.height))
    return np.where(fixed, 0.0, goals - mesh.vertices)


def unfolded(mesh: Mesh, steps: np.ndarray) -> np.ndarray:
    """Shorten steps until no triangle folds.

    Args:
        mesh: A valid mesh.
        steps: Motion of every vertex that respects the border [px], shape [V, 2].

    Returns:
        Steps [px], shape [V, 2], which leave every triangle at least `LOWEST` or its height
        before.
    """
    floor = np.minimum(LOWEST, (1.0 - 1e-9) * mesh.heights)  # but for rounding
    halved = np.zeros(mesh.vertex_count, dtype=np.int64)
    shorter = steps
    # Ends because a triangle of three vertices at rest has its height from before.
    while True:
        folding = heights_of((mesh.vertices + shorter)[mesh.triangles]) < floor
        if not folding.any():
            return shorter
        halved[np.unique(mesh.triangles[folding])] += 1
        share = np.where(halved > HALVINGS, 0.0, 0.5**halved)
        shorter = share[:, None] * steps
