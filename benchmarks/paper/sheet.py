"""Pictures side by side with captions, in PNG files that stay small."""

import io
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from benchmarks.paper.study import Study
from stages.render import Renderer
from stages.snapshot import Snapshot
from warp_kernels.styles.edges import Edges
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient

CELL = 230
"""Width of one picture on a sheet [px]."""
GAP = 4
"""White between pictures [px]."""
LINE = 15
"""Height of a line of a caption [px]."""
LARGEST = 150_000
"""No file is larger [bytes]."""
COLORS = (256, 128, 64, 32)
"""Numbers of colours that are tried until a file is small enough."""

Cell = tuple[np.ndarray, str]
"""A picture [H, W, 3] uint8 and its caption; each line of it has its own row."""


def drawn(study: Study, snapshot: Snapshot, *, lines: bool = False) -> np.ndarray:
    """A snapshot at the width of a cell, [rows, columns, 3] uint8.

    Args:
        study: Owns the device.
        snapshot: What to draw.
        lines: Whether the edges are drawn over it.
    """
    mesh = snapshot.mesh
    output = (CELL, max(1, round(CELL * mesh.height / mesh.width)))
    styles = (Flat() if snapshot.model.degree == 0 else Gradient(),)
    if lines:
        styles = (*styles, Edges(width=0.7 * mesh.width / CELL, color="#222"))
    return Renderer(study.device, (mesh.width, mesh.height), output, styles).render(snapshot)


def error_map(snapshot: Snapshot, triangle_of: np.ndarray, most: float) -> np.ndarray:
    """sqrt(E(T) / |I|) of every pixel's triangle from blue to red, [H, W, 3] uint8.

    Args:
        snapshot: Knows the errors.
        triangle_of: Triangle of each pixel, [H, W].
        most: What is red [code values].
    """
    errors = np.sqrt(snapshot.energies / triangle_of.size)
    shades = (255 * np.clip(errors / most, 0, 1)).astype(np.uint8)
    return cv2.cvtColor(cv2.applyColorMap(shades[triangle_of], cv2.COLORMAP_JET), cv2.COLOR_BGR2RGB)


def save_sheet(path: Path, rows: Sequence[Sequence[Cell]]) -> None:
    """Write rows of pictures with captions as one PNG.

    Args:
        path: The file.
        rows: From top to bottom, pictures from left to right.
    """
    bands = [_band(row) for row in rows if row]
    width = max(band.shape[1] for band in bands)
    bands = [
        np.pad(band, ((0, 0), (0, width - band.shape[1]), (0, 0)), constant_values=255)
        for band in bands
    ]
    save_small(path, np.concatenate(bands))


def _band(row: Sequence[Cell]) -> np.ndarray:
    """One row: captions above pictures."""
    pictures = [_at_cell_width(pixels) for pixels, _ in row]
    height = max(len(pixels) for pixels in pictures)
    top = 4 + LINE * max(len(caption.splitlines()) for _, caption in row)
    band = np.full((top + height + GAP, GAP + len(row) * (CELL + GAP), 3), 255, dtype=np.uint8)
    for number, (pixels, (_, caption)) in enumerate(zip(pictures, row, strict=True)):
        left = GAP + number * (CELL + GAP)
        band[top : top + len(pixels), left : left + CELL] = pixels
        for line, text in enumerate(caption.splitlines()):
            place = (left, LINE * (line + 1) - 2)
            cv2.putText(
                band, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.4, (40, 40, 40), 1, cv2.LINE_AA
            )
    return band


def _at_cell_width(pixels: np.ndarray) -> np.ndarray:
    """A picture scaled to the width of a cell."""
    if pixels.shape[1] == CELL:
        return pixels
    size = (CELL, max(1, round(CELL * pixels.shape[0] / pixels.shape[1])))
    shrinks = pixels.shape[1] > CELL
    return cv2.resize(pixels, size, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_NEAREST)


def save_small(path: Path, pixels: np.ndarray, largest: int = LARGEST) -> None:
    """Write a PNG of few enough colours, then of few enough pixels, to be small.

    Args:
        path: The file.
        pixels: The picture, [H, W, 3] uint8.
        largest: No file is larger [bytes].
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    image = Image.fromarray(pixels)
    while True:
        for colors in COLORS:
            data = io.BytesIO()
            few = image.quantize(colors, dither=Image.Dither.NONE)
            few.save(data, format="PNG", optimize=True)
            if data.tell() <= largest:
                path.write_bytes(data.getvalue())
                return
        image = image.resize((image.width * 4 // 5, image.height * 4 // 5))
