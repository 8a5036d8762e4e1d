"""Draw a snapshot in any stack of styles at any size."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stages.look.fading import Fading
from stages.look.paint import paint_of
from stages.masks.gray import read_gray
from stages.snapshot import Snapshot
from stages.toning.choices import Choices
from stages.toning.tone import Tone, toned
from warp_kernels.device.device import Device
from warp_kernels.drawing.canvas import Canvas
from warp_kernels.drawing.moved import Moved
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE, SAMPLES
from warp_kernels.scene.stroke_lay import Lay
from warp_kernels.styles import Style


class Renderer:
    """Draws the snapshots of one clip; owns the device memory for it.

    Args:
        device: Where kernels run.
        picture: Width and height of the source [px].
        output: Width and height of what is drawn [px].
        styles: Bottom to top.
        masked: Styles over these, each inside of a mask, bottom to top.
        followed: Numbers of the masked styles that are drawn on the triangles of a followed
            region instead.
        moves: Whether triangles are drawn elsewhere than they lie.
        samples: Samples of a pixel, across and down each, as `Canvas` takes them.

    Raises:
        OptionError: If the output is too large or has no pixel.
        MediaError: If a texture cannot be read.
    """

    def __init__(
        self,
        device: Device,
        picture: tuple[int, int],
        output: tuple[int, int],
        styles: tuple[Style, ...],
        masked: tuple[Style, ...] = (),
        followed: tuple[int, ...] = (),
        moves: bool = False,
        samples: int = SAMPLES,
    ) -> None:
        if not 1 <= min(output) <= max(output) <= MAX_SIDE:
            raise OptionError(
                f"an output of {output[0]}x{output[1]}: sides must lie between 1 and {MAX_SIDE} px"
            )
        textures = [style.texture(read_gray) for style in (*styles, *masked)]
        self._canvas = Canvas(
            device, picture, output, styles, masked, textures, followed, moves, samples
        )

    @property
    def is_transparent(self) -> bool:
        """Whether what is drawn has alpha."""
        return self._canvas.channels == 4

    def restyle(self, styles: tuple[Style, ...], masked: tuple[Style, ...] = ()) -> None:
        """Draw with other parameters from now on.

        Args:
            styles: As those that it was made with but for numbers, see `stack_kind`.
            masked: The same.
        """
        self._canvas.restyle(styles, masked)

    def render(
        self,
        snapshot: Snapshot,
        fading: Fading | None = None,
        source: np.ndarray | None = None,
        masks: Sequence[np.ndarray] = (),
        shares: np.ndarray | None = None,
        lay: Lay | None = None,
        columns: Sequence[int] | None = None,
        tone: Tone | None = None,
        choices: Choices | None = None,
        moved: Moved | None = None,
        ground: np.ndarray | None = None,
    ) -> np.ndarray:
        """Draw a snapshot.

        Args:
            snapshot: What to draw.
            fading: What lingers of the frames before it, if anything; it ends with the snapshot.
            source: The picture from which it was made [code values], [H, W, 3] uint8; needed if a
                style does.
            masks: For each masked style that is not followed where it is drawn (255) and where
                not (0), [H, W] uint8.
            shares: Which followed regions the triangles belong to, see `Paint`; with `fading`
                those that it was told.
            lay: How strokes lie; None if they follow the triangles' own base edges; with `fading`
                that which it was told.
            columns: Which of the followed regions it draws; None for all.
            tone: What is done to the colours of triangles; None for nothing.
            choices: Which colours of its palette they have taken; None for the nearest.
            moved: Where triangles are drawn; needed if they move.
            ground: What is seen behind them [code values], [rows, columns, 3] uint8; needed if
                there is a style that stays.

        Returns:
            Code values, [rows, columns, 3] uint8, or [rows, columns, 4] with straight alpha if no
            style of the stack is opaque.
        """
        mesh = snapshot.mesh
        paint, layers = paint_of(snapshot, shares, lay), None
        if fading is not None:
            paint, layers = fading.layers()
        if tone is not None:
            paint = toned(paint, tone, choices)
        if columns is not None and paint.shares is not None:
            paint = replace(paint, shares=np.ascontiguousarray(paint.shares[:, list(columns)]))
        return self._canvas.draw(
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            paint=paint,
            layers=layers,
            source=source,
            masks=masks,
            moved=moved,
            ground=ground,
        )
