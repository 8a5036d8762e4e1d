"""Draw a snapshot in any stack of styles at any size."""

import numpy as np

from stages.snapshot import Snapshot
from warp_kernels.canvas import Canvas
from warp_kernels.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.raster import MAX_SIDE
from warp_kernels.styles import Style


class Renderer:
    """Draws the snapshots of one clip; owns the device memory for it.

    Args:
        device: Where kernels run.
        picture: Width and height of the source [px].
        output: Width and height of what is drawn [px].
        styles: Bottom to top.

    Raises:
        OptionError: If the output is too large or has no pixel.
    """

    def __init__(
        self,
        device: Device,
        picture: tuple[int, int],
        output: tuple[int, int],
        styles: tuple[Style, ...],
    ) -> None:
        if not 1 <= min(output) <= max(output) <= MAX_SIDE:
            raise OptionError(
                f"an output of {output[0]}x{output[1]}: sides must lie between 1 and {MAX_SIDE} px"
            )
        self._canvas = Canvas(device, picture, output, styles)

    def render(self, snapshot: Snapshot) -> np.ndarray:
        """Draw a snapshot.

        Returns:
            Code values, [rows, columns, 3] uint8.
        """
        mesh = snapshot.mesh
        centres = mesh.vertices[mesh.triangles].mean(axis=1)
        colors, gradients = _linear_parts(snapshot, centres)
        return self._canvas.draw(
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            edges=mesh.edge_vertices,
            colors=np.clip(colors, 0.0, 255.0),
            gradients=gradients,
            centres=centres,
        )


def _linear_parts(snapshot: Snapshot, centres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Colour at each triangle's centre and its change per pixel.

    Args:
        snapshot: The triangles and their polynomials.
        centres: Centroids [px], [T, 2].

    Returns:
        Colours [code values], [T, 3], and gradients [code values / px], [T, 2, 3].
    """
    coefficients = snapshot.coefficients
    if snapshot.model.degree == 0:
        return coefficients[:, :, 0], np.zeros((len(coefficients), 2, 3))
    exponents = np.array(snapshot.model.exponents)
    slopes = coefficients[:, :, [snapshot.model.term(1, 0), snapshot.model.term(0, 1)]]
    values = np.prod(centres[:, None, :] ** exponents, axis=2)
    return np.einsum("tck,tk->tc", coefficients, values), slopes.transpose(0, 2, 1)
