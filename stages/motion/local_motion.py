"""How the picture moves around every triangle, as far as vertices tell it together.

A vertex alone tells little: the optimiser has moved it, too. Its neighbours tell the same motion
with other errors, unless they stand on something else.
"""

from dataclasses import dataclass

import numpy as np

from stages.mesh import Mesh

ALIKE = 0.6
"""Steps that differ by so much count by 0.6 of equal ones [px]; as what follows found by trial,
see docs/strokes.md."""
ROUNDS = 3
"""How often every vertex listens to its neighbours."""
FIRM = 30.0
"""Corners so far from their centre, squared and in the mean, turn a triangle by half of what they
say [px^2]."""
LEAST = 1e-9
"""How much a corner counts whose step is like no other."""


@dataclass(frozen=True, eq=False)
class Motions:
    """How triangles have moved, without a change of their shape."""

    steps: np.ndarray
    """Steps of their centroids [px], right + i down, [T]."""
    turns: np.ndarray
    """What turns their directions, complex numbers of length 1, [T]."""


def planar(vectors: np.ndarray) -> np.ndarray:
    """Vectors [..., 2] as complex numbers, right + i down."""
    return vectors[..., 0] + 1j * vectors[..., 1]


def local_motions(mesh: Mesh, steps: np.ndarray, tells: np.ndarray) -> Motions:
    """What triangles and those around them have in common.

    Args:
        mesh: The mesh, after the steps.
        steps: How each vertex has moved [px], [V, 2].
        tells: Whether that says something about the picture, [V] bool; the others go along with
            those around them.

    Source: Tomasi & Manduchi, Bilateral filtering for gray and color images (1998): here of steps
        instead of colours.
    """
    # each inner edge comes in both directions, once from either side
    told_to = mesh.triangles.ravel()
    told_by = np.roll(mesh.triangles, -1, axis=1).ravel()
    count, found, weights = mesh.vertex_count, planar(steps), tells.astype(float)
    for _ in range(ROUNDS):
        told = found[told_by]
        likeness = np.where(weights[told_to] > 0.0, _likeness(told - found[told_to]), 1.0)
        shares = weights[told_by] * likeness
        sums = weights * found + _sums(told_to, shares * told, count)
        totals = weights + np.bincount(told_to, shares, count)
        weights = np.where(totals > 0.0, 1.0, 0.0)
        found = sums / np.maximum(totals, LEAST)
    return _rigid(planar(mesh.vertices)[mesh.triangles], found[mesh.triangles])


def _rigid(corners: np.ndarray, steps: np.ndarray) -> Motions:
    """Rigid motions of triangles, of two corners if the third one goes elsewhere.

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
    return np.exp((differences.real**2 + differences.imag**2) * (-0.5 / ALIKE**2))


def _sums(places: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums of complex values for each of `count` places."""
    right, down = (np.bincount(places, part, count) for part in (values.real, values.imag))
    return right + 1j * down
