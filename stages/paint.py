"""The colours of triangles as styles look at them."""

from dataclasses import dataclass

import numpy as np

from stages.snapshot import Snapshot, colors_at_centres


@dataclass(frozen=True, eq=False)
class Paint:
    """Colours of some triangles."""

    colors: np.ndarray
    """Mean colours, within 0..255 [code values], [N, 3]."""
    gradients: np.ndarray
    """Change of colour to the right and down [code values / px], [N, 2, 3]."""
    centres: np.ndarray
    """Where a triangle has its mean colour [px of the picture], [N, 2]."""

    def of(self, triangles: np.ndarray) -> "Paint":
        """The colours of some of the triangles, by their numbers [M]."""
        return Paint(self.colors[triangles], self.gradients[triangles], self.centres[triangles])


def paint_of(snapshot: Snapshot) -> Paint:
    """The colours of all triangles of a snapshot."""
    mesh = snapshot.mesh
    colors = colors_at_centres(mesh, snapshot.model, snapshot.coefficients)
    return Paint(
        colors=np.clip(colors, 0.0, 255.0),
        gradients=_gradients(snapshot),
        centres=mesh.vertices[mesh.triangles].mean(axis=1),
    )


def joined_paint(parts: list[Paint]) -> Paint:
    """Colours one after the other."""
    return Paint(
        np.concatenate([part.colors for part in parts]),
        np.concatenate([part.gradients for part in parts]),
        np.concatenate([part.centres for part in parts]),
    )


def _gradients(snapshot: Snapshot) -> np.ndarray:
    """Linear part of the colours [code values / px], [T, 2, 3]."""
    coefficients, model = snapshot.coefficients, snapshot.model
    if model.degree == 0:
        return np.zeros((len(coefficients), 2, 3))
    slopes = coefficients[:, :, [model.term(1, 0), model.term(0, 1)]]
    return slopes.transpose(0, 2, 1)
