"""The path of what a person holds fast: nothing but the motion of the picture moves it."""

import numpy as np

from stages.flows.passage import Passage
from stages.hand.locks import Locks
from stages.mesh import Mesh

UNLIKE = 0.9
"""A lock ends where the patch around it differs by this part of its contrast from where it went:
what is there is covered. Patches of different things differ by 1.1 of it."""
NOISE = 6.0
"""Differences below this are noise [code values]."""


def held_path(
    mesh: Mesh, steps: np.ndarray, passage: Passage, locks: Locks
) -> tuple[np.ndarray, Locks]:
    """Follow held vertices closely, and let go of those that are covered or leave the picture.

    Args:
        mesh: A valid mesh.
        steps: Motion of every vertex [px], shape [V, 2].
        passage: Leads from the mesh's frame to the next.
        locks: What is held.

    Returns:
        The steps, those of held vertices by the patches around them [px], and what is held on to.
    """
    held = np.flatnonzero(np.isin(mesh.vertex_ids, locks.vertices))
    if not len(held):
        return steps, locks
    points = mesh.vertices[held]
    near = passage.pursue(points, steps[held])
    misfits, contrasts = passage.unlikeness(points, near).T
    size = np.array([mesh.width, mesh.height])
    border = np.stack([mesh.on_left_right, mesh.on_top_bottom], axis=1)[held]
    there = points + near
    leaves = (~border & ((there <= 0) | (there >= size))).any(axis=1)
    ends = leaves | (misfits > UNLIKE * contrasts + NOISE)
    steps = steps.copy()
    steps[held] = near
    return steps, locks.without(vertices=mesh.vertex_ids[held[ends]])
