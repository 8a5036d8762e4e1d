"""The triangles of a snapshot as styles look at them."""

import numpy as np

from stages.mesh import centres_of
from stages.snapshot import Snapshot, colors_at
from warp_kernels.drawing.paint import Paint
from warp_kernels.scene.stroke_lay import Lay


def paint_of(snapshot: Snapshot, shares: np.ndarray | None = None, lay: Lay | None = None) -> Paint:
    """Shapes and colours of all triangles of a snapshot.

    Args:
        snapshot: The frame.
        shares: Which followed regions each belongs to, see `Paint`; None if there are none.
        lay: How strokes lie on them; None if they follow the triangles' own base edges.
    """
    mesh, model, coefficients = snapshot.mesh, snapshot.model, snapshot.coefficients
    corners = mesh.corners
    centres = centres_of(corners)
    colors = colors_at(model, coefficients, centres)
    gradients = np.zeros((len(coefficients), 2, 3))
    curvatures = None
    if model.degree > 0:
        slopes = coefficients[:, :, [model.term(1, 0), model.term(0, 1)]]
        gradients += slopes.transpose(0, 2, 1)
    if model.degree > 1:
        curvatures = _curvatures(snapshot)
        x, y = centres[:, :1], centres[:, 1:]
        gradients[:, 0] += 2 * x * curvatures[:, 1] + y * curvatures[:, 2]
        gradients[:, 1] += x * curvatures[:, 2] + 2 * y * curvatures[:, 3]
        colors = colors - curvatures[:, 0]
    limits = snapshot.bounds
    colors = np.clip(colors, limits[:, 0], limits[:, 1])
    return Paint(colors, gradients, curvatures, limits, corners, mesh.triangle_ids, shares, lay)


def _curvatures(snapshot: Snapshot) -> np.ndarray:
    """Quadratic part of the colours around the centroids, see `Scene`, [T, 4, 3]."""
    mesh, model = snapshot.mesh, snapshot.model
    terms = [model.term(2, 0), model.term(1, 1), model.term(0, 2)]
    bends = snapshot.coefficients[:, :, terms].transpose(0, 2, 1)
    corners = mesh.corners
    # over a triangle the mean of x^2 from the centroid is that over the corners divided by 4
    away = corners - centres_of(corners)[:, None]
    squares = away[:, :, [0, 0, 1]] * away[:, :, [0, 1, 1]]
    bulge = np.einsum("tk,tkc->tc", squares.mean(axis=1) / 4, bends)
    return np.concatenate([-bulge[:, None], bends], axis=1)
