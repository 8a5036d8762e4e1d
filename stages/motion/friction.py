"""What keeps vertices where they are while the picture around them stays as it is."""

import numpy as np

from stages.mesh import Mesh
from stages.motion.correspondence import kept_vertices
from stages.motion.rest import Rest

LARGEST = 0.5
"""Steps below this do not move a vertex off a place at which all stays as it is [px]. Nearly all
that noise draws at vertices with is below 0.3 px, and what has not arrived yet takes longer
steps."""
SLIDE = 0.05
"""Friction falls with the way that the motion takes a vertex, to none at this one [px]: less is
what flow sees in noise, more is a motion, along which a vertex has to find its place anew."""
AS_IT_WAS = 0.1
"""All stays as it is where the energy of the triangles around changes by less than this part."""
TURNS = 4
"""In one of so many frames each vertex is without friction: what changes by little at a time is
followed all the same, and not in all places in the same frame."""


def friction_of(
    before: Mesh, had: np.ndarray, mesh: Mesh, energies: np.ndarray, turn: int
) -> np.ndarray:
    """Tell how far each vertex must be drawn before it leaves the place that it came along to.

    Args:
        before: The mesh of the frame before.
        had: E(T) there, in its picture [code value^2 px], [T].
        mesh: The same, where the motion took it.
        energies: E(T) of that in the new picture, weighted as `had` is.
        turn: The number of the frame: by it and their ids vertices take turns.

    Returns:
        Shortest first steps that are taken [px], [V]; 0 where any step is.

    Deviation: the paper has no such term; in films of cameras that stand still noise moved two
        thirds of the vertices in every frame.
    """
    rows = kept_vertices(before, mesh)
    way = np.abs(mesh.vertices - before.vertices.take(rows, axis=0)).max(axis=1)
    friction = LARGEST * np.clip(1.0 - way / SLIDE, 0.0, 1.0)
    changed = Rest.after(before, had, mesh, energies, AS_IT_WAS).free(mesh)
    freed = (mesh.vertex_ids + turn) % TURNS == 0
    friction[changed | freed | (rows < 0)] = 0.0
    return friction
