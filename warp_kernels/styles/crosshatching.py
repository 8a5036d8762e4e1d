"""Strokes that cross."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.drawn import Drawn


@dataclass(frozen=True)
class Crosshatching(Drawn):
    """Lines along the base edge of each triangle, crossed by others the darker it is.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6e.
    """

    drawing = Imported("warp_kernels.styles.tones.tonal_art_map:crossing_strokes")
    portraits: ClassVar[tuple[str, ...]] = ("crosshatching:paper=#f8f4ea,spacing=3",)
