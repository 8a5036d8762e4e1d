"""The colours of triangles as styles look at them."""

from dataclasses import dataclass

import numpy as np

from stages.snapshot import Snapshot, colors_at_centres


@dataclass(frozen=True, eq=False)
class Paint:
    """Colour polynomials of some triangles, around their centroids."""

    colors: np.ndarray
    """Mean colours, within 0..255 [code values], [N, 3]."""
    gradients: np.ndarray
    """Change of colour to the right and down [code values / px], [N, 2, 3]."""
    curvatures: np.ndarray | None
    """What quadratic colours add, see `Scene`, [N, 4, 3]; None for others."""
    centres: np.ndarray
    """Centroids [px of the picture], [N, 2]."""

    def of(self, triangles: np.ndarray) -> "Paint":
        """The colours of some of the triangles, by their numbers [M]."""
        return Paint(
            self.colors[triangles],
            self.gradients[triangles],
            None if self.curvatures is None else self.curvatures[triangles],
            self.centres[triangles],
        )


def paint_of(snapshot: Snapshot) -> Paint:
    """The colours of all triangles of a snapshot."""
    mesh, model, coefficients = snapshot.mesh, snapshot.model, snapshot.coefficients
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    colors = colors_at_centres(mesh, model, coefficients)
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
    return Paint(np.clip(colors, 0.0, 255.0), gradients, curvatures, centres)


def joined_paint(parts: list[Paint]) -> Paint:
    """Colours of one model, one after the other."""
    curvatures = [part.curvatures for part in parts if part.curvatures is not None]
    return Paint(
        np.concatenate([part.colors for part in parts]),
        np.concatenate([part.gradients for part in parts]),
        np.concatenate(curvatures) if curvatures else None,
        np.concatenate([part.centres for part in parts]),
    )


def _curvatures(snapshot: Snapshot) -> np.ndarray:
    """Quadratic part of the colours around the centroids, see `Scene`, [T, 4, 3]."""
    mesh, model = snapshot.mesh, snapshot.model
    terms = [model.term(2, 0), model.term(1, 1), model.term(0, 2)]
    bends = snapshot.coefficients[:, :, terms].transpose(0, 2, 1)
    corners = mesh.vertices[mesh.triangles]
    # over a triangle the mean of x^2 from the centroid is that over the corners divided by 4
    away = corners - corners.mean(axis=1, keepdims=True)
    squares = away[:, :, [0, 0, 1]] * away[:, :, [0, 1, 1]]
    bulge = np.einsum("tk,tkc->tc", squares.mean(axis=1) / 4, bends)
    return np.concatenate([-bulge[:, None], bends], axis=1)
