"""Triangle by triangle from one picture to another: masks that tell what is seen of both."""

from dataclasses import replace

import numpy as np

from stages.look.paint import paint_of
from stages.look.transitions import ONE
from stages.snapshot import Snapshot
from warp_kernels.device.device import Device
from warp_kernels.drawing.canvas import Canvas
from warp_kernels.scene.places import hashes_of
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.veil import Veil

WAITING = {"scatter": 0.12, "grow": 0.35}
"""How long a triangle takes on its way, as a part of the whole; the rest of the time it waits for
its turn."""


class Curtain:
    """Draws the masks of one kind of transition; owns the device memory for it.

    Args:
        device: Where kernels run.
        picture: Width and height of the source [px].
        output: Width and height of what is drawn [px].
        kind: `scatter` or `grow`.
    """

    def __init__(
        self, device: Device, picture: tuple[int, int], output: tuple[int, int], kind: str
    ) -> None:
        style: Style = Veil() if kind == "grow" else STYLES["flat"]()
        self._canvas = Canvas(device, picture, output, (style,), (), [None])
        self._kind = kind

    def weights(self, snapshot: Snapshot, share: float) -> tuple[np.ndarray, np.ndarray]:
        """How much is seen of both pictures; what is left shows the ground.

        Args:
            snapshot: The frame; a triangle's turn follows from its id.
            share: How much of the way is done, 0 to 1.

        Returns:
            Of the picture that goes and of that which comes, 0 to `ONE`, [H, W] int32.
        """
        mesh = snapshot.mesh
        way = ways_of(mesh.triangle_ids, share, WAITING[self._kind])
        parts = (1.0 - way, way)
        if self._kind == "grow":
            parts = (np.maximum(1.0 - 2.0 * way, 0.0), np.maximum(2.0 * way - 1.0, 0.0))
        colors = np.stack([255.0 * parts[0], 255.0 * parts[1], np.zeros_like(way)], axis=1)
        paint = replace(paint_of(snapshot), colors=colors)
        drawn = self._canvas.draw(vertices=mesh.vertices, triangles=mesh.triangles, paint=paint)
        one, other = ((drawn[..., i].astype(np.int32) * ONE + 127) // 255 for i in (0, 1))
        return (one, other) if self._kind == "grow" else (ONE - other, other)


def ways_of(ids: np.ndarray, share: float, waiting: float) -> np.ndarray:
    """How far every triangle is on its way, 0 to 1, [T]; its turn stays with its id.

    Args:
        ids: Persistent numbers of the triangles, [T].
        share: How much of the whole is done, 0 to 1.
        waiting: How long each takes, as a part of the whole, above 0.
    """
    turns = hashes_of(ids) / float(1 << 32)
    way = np.clip((share - (1.0 - waiting) * turns) / waiting, 0.0, 1.0)
    return np.asarray(way * way * (3.0 - 2.0 * way))
