"""Jitter: how unsteadily vertices leave the paths that the source's motion gives them."""

from dataclasses import dataclass

import numpy as np

from stages.flows.field import FlowField
from stages.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Drift:
    """Motion of vertices beside that of the source, from one frame to the next."""

    vertex_ids: np.ndarray
    """Vertices of both frames, ascending, shape [N]."""
    steps: np.ndarray
    """Their steps less the source's motion [px], shape [N, 2]."""


def drift(before: Mesh, after: Mesh, flow: FlowField) -> Drift:
    """Compare the steps of vertices with the source's motion under them.

    Args:
        before: A frame's mesh.
        after: The next frame's, whose ids go on from there.
        flow: Motion of the source between the two.
    """
    ids, old, new = np.intersect1d(
        before.vertex_ids, after.vertex_ids, assume_unique=True, return_indices=True
    )
    starts = before.vertices[old]
    steps = after.vertices[new] - starts - flow.at(starts)
    # Across the border a vertex cannot follow.
    steps[before.on_left_right[old], 0] = 0.0
    steps[before.on_top_bottom[old], 1] = 0.0
    return Drift(ids, steps)


def jitter(earlier: Drift, later: Drift) -> float | None:
    """Mean length of the second difference of the vertices' paths, the source's motion taken off.

    Args:
        earlier: Drift to a frame.
        later: Drift from that frame on.

    Returns:
        Mean over the vertices of all three frames [px]; None if there are none.
    """
    ids, old, new = np.intersect1d(
        earlier.vertex_ids, later.vertex_ids, assume_unique=True, return_indices=True
    )
    if not len(ids):
        return None
    difference = later.steps[new] - earlier.steps[old]
    return float(np.hypot(*difference.T).mean())
