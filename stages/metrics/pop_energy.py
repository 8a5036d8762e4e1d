"""Pop energy: what changes of topology change in the picture."""

import numpy as np

from stages.flows.field import FlowField
from stages.metrics.locate import locate
from stages.metrics.motion import SourceMotion
from stages.metrics.numbering import keys_of, numbers_of
from stages.snapshot import Snapshot, colors_at

WHITE = 255.0
"""Code value of the colour 1."""


def pop_energy(before: Snapshot, after: Snapshot, motion: SourceMotion) -> float:
    """Area times squared change of colour of the triangles that come and go.

    A triangle is its three vertices: splits, collapses and flips all exchange triangles. One that
    comes is compared, at its centroid, with what was there before, along the motion of the
    source; one that goes with what is there afterwards. Both cover the same part of the picture,
    so the mean of the two sums counts.

    Args:
        before: A frame.
        after: The next frame, whose ids go on from there.
        motion: Motion of the source between the two.

    Returns:
        Mean over the whole picture and the channels of the squared change, colours in [0, 1]: in
        the unit of E_warp.
    """
    first, second, count = numbers_of(before.mesh, after.mesh)
    rows = (
        keys_of(first[before.mesh.triangles], count),
        keys_of(second[after.mesh.triangles], count),
    )
    gone = np.flatnonzero(~np.isin(*rows, assume_unique=True))
    come = np.flatnonzero(~np.isin(*rows[::-1], assume_unique=True))
    forth = _change(before, gone, after, motion.forward)
    back = _change(after, come, before, motion.backward)
    return 0.5 * (forth + back)


def _change(one: Snapshot, chosen: np.ndarray, other: Snapshot, flow: FlowField) -> float:
    """Sum over chosen triangles of one frame, per pixel of the picture."""
    if not len(chosen):
        return 0.0
    mesh = one.mesh
    size = (mesh.width, mesh.height)
    centres = mesh.vertices[mesh.triangles[chosen]].mean(axis=1)
    places = np.clip(centres + flow.at(centres), 0, size)
    there = locate(other.mesh, places)
    own = colors_at(one.model, one.coefficients[chosen], centres)
    found = colors_at(other.model, other.coefficients[there], places)
    squares = np.square((np.clip(own, 0, WHITE) - np.clip(found, 0, WHITE)) / WHITE).mean(axis=1)
    return float((mesh.areas[chosen] * squares).sum() / (mesh.width * mesh.height))
