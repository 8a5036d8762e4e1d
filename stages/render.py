"""Draw a snapshot in any stack of styles at any size."""

import numpy as np

from stages.snapshot import Snapshot, colors_at_centres
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
        colors = colors_at_centres(mesh, snapshot.model, snapshot.coefficients)
        return self._canvas.draw(
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            edges=mesh.edge_vertices,
            colors=np.clip(colors, 0.0, 255.0),
            gradients=_gradients(snapshot),
            centres=centres,
        )


def _gradients(snapshot: Snapshot) -> np.ndarray:
    """Linear part of the colours [code values / px], [T, 2, 3]."""
    coefficients, model = snapshot.coefficients, snapshot.model
    if model.degree == 0:
        return np.zeros((len(coefficients), 2, 3))
    slopes = coefficients[:, :, [model.term(1, 0), model.term(0, 1)]]
    return slopes.transpose(0, 2, 1)
