"""How the picture moves around every triangle, as far as its vertices tell together.

A vertex alone tells little: the optimiser has moved it, too. Its neighbours tell the same motion
with other errors, unless they stand on something else.
"""

from dataclasses import dataclass

import numpy as np

from stages.mesh import Mesh

ALIKE = 0.6
"""Steps that differ by this count to a share of 0.6 for the same motion [px]; found by trial, see
docs/strokes.md."""
ROUNDS = 3
"""How often every vertex listens to its neighbours."""
FIRM = 30.0
"""A triangle whose corners lie this far from its centre, squared, turns by half of what they say
[px^2]."""
LEAST = 1e-9
"""Share with which a vertex insists on its own step where nobody says the same."""


@dataclass(frozen=True, eq=False)
class Motions:
    """How some triangles move from one frame to the next: rigidly."""

    steps: np.ndarray
    """Steps of their centroids, right and down as one complex number each [px], [T]."""
    turns: np.ndarray
    """What directions are multiplied by: complex numbers of length 1, [T]."""


def planar(vectors: np.ndarray) -> np.ndarray:
    """Vectors [..., 2] as complex numbers, right and down."""
    return vectors[..., 0] + 1j * vectors[..., 1]


def local_motions(mesh: Mesh, steps: np.ndarray) -> Motions:
    """What triangles and those around them have in common.

    Args:
        mesh: The mesh, after the steps.
        steps: How each vertex has moved [px], [V, 2].

    Source: Tomasi & Manduchi, Bilateral filtering for gray and color images (1998), on the steps
        of a mesh instead of on colours.
    """
    found = planar(steps)
    tails, heads = mesh.edge_vertices.T
    ends = np.concatenate([tails, heads]), np.concatenate([heads, tails])
    for _ in range(ROUNDS):
        told = found[ends[1]]
        shares = _likeness(told - found[ends[0]])
        # its own step counts like that of a neighbour who says the same
        sums = found + _sums(ends[0], shares * told, len(found))
        found = sums / (1.0 + np.bincount(ends[0], shares, len(found)))
    return _rigid(planar(mesh.vertices)[mesh.triangles], found[mesh.triangles])


def _rigid(corners: np.ndarray, steps: np.ndarray) -> Motions:
    """The rigid motions nearest to those of three corners each, of two if one goes elsewhere.

    Args:
        corners: Where they are [px], [T, 3] complex.
        steps: How they came there [px], [T, 3] complex.
    """
    middle = np.median(steps.real, axis=1) + 1j * np.median(steps.imag, axis=1)
    shares = _likeness(steps - middle[:, None]) + LEAST
    shares /= shares.sum(axis=1, keepdims=True)
    step, centre = (shares * steps).sum(axis=1), (shares * corners).sum(axis=1)
    away, along = corners - centre[:, None], steps - step[:, None]
    turned = (shares * (along * away.conj()).imag).sum(axis=1)
    spread = (shares * (away.real**2 + away.imag**2)).sum(axis=1)
    angle = turned / (spread + FIRM)
    return Motions(step + 1j * angle * (corners.mean(axis=1) - centre), np.exp(1j * angle))


def _likeness(differences: np.ndarray) -> np.ndarray:
    """How far steps with such differences [px, complex] count for one motion, 0 to 1."""
    return np.exp(-(differences.real**2 + differences.imag**2) / (2.0 * ALIKE**2))


def _sums(places: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums of complex values for each of `count` places."""
    parts = (np.bincount(places, part, count) for part in (values.real, values.imag))
    return next(parts) + 1j * next(parts)
