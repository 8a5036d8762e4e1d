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
        colors, gradients, curvatures = _expanded(snapshot)
        return self._canvas.draw(
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            edges=mesh.edge_vertices,
            colors=np.clip(colors, 0.0, 255.0),
            gradients=gradients,
            curvatures=curvatures,
            centres=mesh.vertices[mesh.triangles].mean(axis=1),
        )


def _expanded(snapshot: Snapshot) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """The colour polynomials around the triangles' centroids.

    Returns:
        Mean colours [T, 3], gradients [T, 2, 3], and curvatures [T, 4, 3] of quadratic colours,
        see `Scene`.
    """
    mesh, model, coefficients = snapshot.mesh, snapshot.model, snapshot.coefficients
    corners = mesh.vertices[mesh.triangles]
    centres = corners.mean(axis=1)
    colors = colors_at_centres(mesh, model, coefficients)
    gradients = np.zeros((len(coefficients), 2, 3))
    if model.degree > 0:
        slopes = coefficients[:, :, [model.term(1, 0), model.term(0, 1)]]
        gradients += slopes.transpose(0, 2, 1)
    if model.degree < 2:
        return colors, gradients, None
    terms = [model.term(2, 0), model.term(1, 1), model.term(0, 2)]
    bends = coefficients[:, :, terms].transpose(0, 2, 1)
    x, y = centres[:, :1], centres[:, 1:]
    gradients[:, 0] += 2 * x * bends[:, 0] + y * bends[:, 1]
    gradients[:, 1] += x * bends[:, 1] + 2 * y * bends[:, 2]
    # over a triangle the mean of x^2 from the centroid is that over the corners divided by 4
    away = corners - centres[:, None]
    squares = away[:, :, [0, 0, 1]] * away[:, :, [0, 1, 1]]
    bulge = np.einsum("tk,tkc->tc", squares.mean(axis=1) / 4, bends)
    return colors + bulge, gradients, np.concatenate([-bulge[:, None], bends], axis=1)
