"""One picture as triangles: what programs get to see of a snapshot."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from pipeline.library.draw import drawn
from pipeline.library.given import file_name, given_values
from pipeline.library.keywords import Name, SaveKeywords
from pipeline.library.wording import worded
from stages.frame import Frame
from stages.look.paint import paint_of
from stages.media.writing.still_writer import encode_still
from stages.snapshot import Snapshot
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.limits import SAMPLES


@dataclass(frozen=True)
class Origin:
    """Where a triangulation comes from."""

    color: str
    """Name of the colour model that was optimised."""
    shot: int = 0
    """Number of the frame with which its shot begins."""
    time: float | None = None
    """When it is shown [s from the first frame of the source], or None."""
    frame: Frame | None = None
    """The picture, or None if only its triangles were kept."""
    device: str = "auto"
    """Where kernels ran."""
    threads: int = 0
    """Threads of the CPU, 0 for one per core."""


class Triangulation:
    """One picture as triangles; its arrays cannot be written to.

    Positions are in pixels, x right and y down, (0, 0) the upper left corner of the upper left
    pixel. In a notebook it shows itself.

    Made by `triangulate`, an `Animator` or a `Track`.
    """

    def __init__(self, snapshot: Snapshot, origin: Origin) -> None:
        """Look at a snapshot; see `triangulate`."""
        self._snapshot = snapshot
        self._origin = origin

    @property
    def frame(self) -> int:
        """Number of the frame."""
        return self._snapshot.frame_index

    @property
    def shot(self) -> int:
        """Number of the frame with which its shot begins: ids mean the same until the next one."""
        return self._origin.shot

    @property
    def time(self) -> float | None:
        """When it is shown [s from the first frame of its source]; None if it came as an array."""
        return self._origin.time

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture [px]."""
        return self._snapshot.mesh.width, self._snapshot.mesh.height

    @property
    def vertices(self) -> np.ndarray:
        """Positions [px], shape [V, 2] float64."""
        return self._snapshot.mesh.vertices

    @property
    def triangles(self) -> np.ndarray:
        """Rows of `vertices` at the corners, clockwise as seen, shape [T, 3] int32."""
        return self._snapshot.mesh.triangles

    @property
    def vertex_ids(self) -> np.ndarray:
        """A number for each vertex that it keeps from frame to frame, ascending, [V] int64."""
        return self._snapshot.mesh.vertex_ids

    @property
    def triangle_ids(self) -> np.ndarray:
        """A number for each triangle that it keeps from frame to frame, ascending, [T] int64."""
        return self._snapshot.mesh.triangle_ids

    @cached_property
    def colors(self) -> np.ndarray:
        """Mean colours, RGB code values, shape [T, 3] uint8."""
        colors = np.rint(paint_of(self._snapshot).colors).astype(np.uint8)
        colors.flags.writeable = False
        return colors

    @property
    def rmse(self) -> float:
        """Root mean square error over pixels and channels [code values]."""
        return self._snapshot.rmse

    @worded()
    def draw(
        self,
        styles: str | Sequence[str] = (),
        scale: float | None = None,
        *,
        size: str | tuple[int, int] | None = None,
        samples: int = SAMPLES,
        fit: str = "contain",
        background: str | None = None,
        moves: str | Sequence[str] = (),
        palette: str | None = None,
        grade: str | None = None,
        device: str | None = None,
        threads: int | None = None,
    ) -> np.ndarray:
        """Draw it.

        Args:
            styles: One or several, bottom to top, as on the command line: `edges:width=2`; the
                triangles in their own colours if left out.
            scale: Size of what is drawn relative to the picture.
            size: Width and height instead [px], or a text as on the command line: `1080x`.
            samples: Samples of a pixel, across and down each: 4 makes borders smoother.
            fit: How the picture gets into another shape: `contain`, `cover` or `stretch`.
            background: Colour of bars, and of what transparent styles leave open.
            moves: How its triangles move, one or several: `explode:amount=0.3`.
            palette: Colours that those of the triangles become: `#123,#fa0,white`, a file.
            grade: Change of their colours: `exposure=0.5,saturation=0.8`.
            device: Where kernels run; if left out, where they ran before.
            threads: Threads of the CPU; if left out, as many as before.

        Returns:
            Code values, [rows, columns, 3] uint8, or [rows, columns, 4] with straight alpha if
            no style is opaque, or moves leave holes.

        Raises:
            OptionError: If a value is impossible, or a style needs the picture and it was not kept.
        """
        origin = self._origin
        options: dict[str, Any] = {"styles": styles, "scale": scale, "size": size}
        options["samples"] = samples
        options |= {"fit": fit, "background": background, "moves": moves}
        options |= {"palette": palette, "grade": grade}
        options["device"] = origin.device if device is None else device
        options["threads"] = origin.threads if threads is None else threads
        model = COLOR_MODELS[origin.color]
        return drawn(
            self._snapshot, origin.frame, origin.time, model, given_values("draw", options)
        )

    @worded()
    def save(
        self, path: Name, styles: str | Sequence[str] = (), **options: Unpack[SaveKeywords]
    ) -> list[str]:
        """Write it as shapes and numbers: `.svg`, `.dxf`, `.glb`, `.npz` and others.

        Args:
            path: The file; its ending says how it is written.
            styles: As `draw` takes them; a format holds some of them.
            options: As on the command line: `mm=200`, `svg_merge=True`, `overwrite=True`.

        Returns:
            Choices that were made, one sentence each.

        Raises:
            OptionError: If a value is impossible, or the format cannot hold the look.
            OutputError: If the file cannot be written, or is there already.
        """
        origin = self._origin
        given = given_values("save", options)
        given |= given_values("draw", {"styles": styles})
        given = {"device": origin.device, "threads": origin.threads, **given}
        from pipeline.library.shapes import written

        return written(
            self._snapshot,
            origin.frame,
            origin.shot,
            COLOR_MODELS[origin.color],
            Path(file_name("path", path)),
            given,
        )

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        return encode_still(self.draw(), "png", None)

    def __repr__(self) -> str:
        width, height = self.size
        return (
            f"<Triangulation of frame {self.frame}: {len(self.triangles)} triangles, "
            f"{width}x{height}, rmse {self.rmse:.2f}>"
        )
