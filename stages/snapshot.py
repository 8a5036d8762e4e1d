"""The finished triangulation of one frame: a mesh and the colours that fit it."""

from dataclasses import dataclass, replace
from fractions import Fraction
from math import comb

import numpy as np

from stages.frame import Frame
from stages.hand.locks import NO_LOCKS, Locks
from stages.mesh import Mesh, centres_of
from warp_kernels.color_model import CHANNELS, ColorModel


@dataclass(frozen=True, eq=False)
class Snapshot:
    """What one frame of a clip became; all that a renderer needs."""

    frame_index: int
    """Number of the frame in the source."""
    pts: int
    """Presentation time in units of `time_base`."""
    time_base: Fraction
    """Seconds per unit of `pts`."""
    mesh: Mesh
    """The triangles."""
    model: ColorModel
    """The colour model that was optimised."""
    coefficients: np.ndarray
    """Per triangle and channel the coefficients of x^a y^b, x and y positions in the picture,
    in the order of `model.exponents` [code value / px^(a + b)], shape [T, 3, K] float64."""
    energies: np.ndarray
    """E(T) of Eq. 4 [code value^2 px], of RGB whatever the space that was optimised, shape [T]
    float64; where pixels have weights, these divided by their mean over the picture are factors
    of the errors."""
    counts: np.ndarray
    """Pixels covered, or the sum of their weights up to a common factor, shape [T] int64; where
    this is 0 the colour is that of a neighbour."""
    limits: np.ndarray | None = None
    """The lowest and the highest value of every channel that a triangle shows, whatever its
    polynomial says [code values], shape [T, 2, 3]; None for 0 and 255."""
    locks: Locks = NO_LOCKS
    """What of the mesh a person holds fast."""

    @property
    def bounds(self) -> np.ndarray:
        """The limits, 0 and 255 where there are none [code values], shape [T, 2, 3]."""
        if self.limits is not None:
            return self.limits
        return np.broadcast_to([[[0.0], [255.0]]], (len(self.coefficients), 2, CHANNELS))

    @property
    def rmse(self) -> float:
        """Root mean square error over pixels and channels [code values].

        The colours are clipped to `limits` only when they are drawn, so this is the error of the
        fit; no pixel leaves the limits, so what is drawn at the pixels' centres has no larger one.
        Eq. 12's R is sqrt(3 / 2) of it. Where pixels have weights the mean is weighted.
        """
        samples = CHANNELS * self.mesh.width * self.mesh.height
        return float(np.sqrt(2.0 * self.energies.sum() / samples))

    def again(self, frame: Frame) -> "Snapshot":
        """The same for a later frame of the same picture."""
        return replace(self, frame_index=frame.index, pts=frame.pts, time_base=frame.time_base)


def colors_at_centres(mesh: Mesh, model: ColorModel, coefficients: np.ndarray) -> np.ndarray:
    """Values of the colour polynomials at the triangles' centroids.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].

    Returns:
        Colours, not clipped [code values], [T, 3].
    """
    return colors_at(model, coefficients, centres_of(mesh.corners))


def colors_at(model: ColorModel, coefficients: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Values of some colour polynomials, each at a point.

    Args:
        model: Fixes the terms.
        coefficients: Those of a triangle for every point, [N, 3, K].
        points: Positions [px], [N, 2].

    Returns:
        Colours, not clipped [code values], [N, 3].
    """
    if model.degree == 0:
        return coefficients[:, :, 0]
    x, y = points.T
    terms = np.stack([x**a * y**b for a, b in model.exponents], axis=1)
    return np.einsum("tck,tk->tc", coefficients, terms)


def with_origins(model: ColorModel, coefficients: np.ndarray, origins: np.ndarray) -> np.ndarray:
    """Coefficients of the same colour polynomials in positions that count from other origins.

    Args:
        model: Fixes the terms.
        coefficients: Of x^a y^b, [T, 3, K].
        origins: For each triangle where x and y shall be zero [px], [T, 2].

    Returns:
        Coefficients of (x - x0)^a (y - y0)^b, [T, 3, K].
    """
    if model.degree == 0:
        return coefficients
    x, y = origins.T
    matrix = np.zeros((len(origins), model.term_count, model.term_count))
    for old, (a, b) in enumerate(model.exponents):
        for new, (i, j) in enumerate(model.exponents):
            if i <= a and j <= b:
                matrix[:, new, old] = comb(a, i) * comb(b, j) * x ** (a - i) * y ** (b - j)
    return np.einsum("tnk,tck->tcn", matrix, coefficients)
