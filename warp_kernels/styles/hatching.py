"""Parallel strokes."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.drawn import Drawn


@dataclass(frozen=True)
class Hatching(Drawn):
    """Lines along the base edge of each triangle.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6d, after
        drawings of Josh Bryan.
    """

    drawing = Imported("warp_kernels.styles.tones.tonal_art_map:parallel_strokes")
    portraits: ClassVar[tuple[str, ...]] = (
        "hatching",
        "hatching:paper=#f8f4ea",
        "hatching:colored=1",
    )
