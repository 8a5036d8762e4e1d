"""Textures that are drawn on the page: shown at once, and kept for good."""

import base64
import binascii
import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from stages.media.embedded import embedded
from stages.media.writing.commit import write_file
from stages.media.writing.still_writer import encode_still
from warp_kernels.errors import OptionError
from warp_kernels.styles.style import ReadPicture
from warp_kernels.styles.texture import Texture

if TYPE_CHECKING:
    from warp_kernels.scene.texels import Texels

SIDE = 256
"""Width and height of what is drawn [px]."""


@dataclass(frozen=True)
class Sketch(Texture):
    """A texture that lies in no file yet; without a drawing one of those that there are."""

    drawing: bytes = field(default=b"", repr=False)
    """Code values, row by row, `SIDE` x `SIDE`; empty if `file` says what it is."""

    built_from: ClassVar[tuple[str, ...]] = ("file", "drawing")

    def texture(self, read: ReadPicture) -> "Texels | None":
        """What was drawn."""
        if not self.drawing:
            return super().texture(read)
        from warp_kernels.scene.texels import Texels

        return Texels.of(_gray(self.drawing)[None] / 255.0).with_neighbours(repeats=False)


def drawing_of(text: str) -> bytes:
    """What a window has drawn.

    Args:
        text: Its code values in base64.

    Returns:
        Code values, row by row.

    Raises:
        OptionError: If it is none.
    """
    try:
        drawing = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        drawing = b""
    if len(drawing) != SIDE * SIDE:
        raise OptionError(f"a drawing is {SIDE} x {SIDE} bytes in base64; this is none")
    return drawing


def embedded_drawing(drawing: bytes) -> str:
    """A drawing as edits hold it themselves, so that it goes wherever the log goes.

    Args:
        drawing: Code values, row by row.
    """
    return embedded(_png(drawing))


def keep_drawing(drawing: bytes, track: Path) -> Path:
    """Write a drawing beside a track; the same drawing is the same file.

    A style names it, so it is never written over.

    Args:
        drawing: Code values, row by row.
        track: The track.

    Returns:
        The file, as one that is found from everywhere.

    Raises:
        OutputError: If it cannot be written.
    """
    digest = hashlib.sha256(drawing).hexdigest()[:10]
    path = track.absolute().with_name(f"{track.stem}.texture-{digest}.png")
    if not path.exists():
        write_file(path, _png(drawing))
    return path


def _png(drawing: bytes) -> bytes:
    """The content of a PNG."""
    return encode_still(np.repeat(_gray(drawing)[:, :, None], 3, axis=2), "png", None)


def _gray(drawing: bytes) -> np.ndarray:
    """Code values, [SIDE, SIDE] uint8."""
    return np.frombuffer(drawing, dtype=np.uint8).reshape(SIDE, SIDE)
