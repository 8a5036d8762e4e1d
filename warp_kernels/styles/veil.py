"""Masks of transitions: no style that a user names."""

from dataclasses import dataclass

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Veil(Style):
    """Two masks, of triangles that are as large as their colours say."""

    shader = Imported("warp_kernels.styles.shaders.veil:veil_color")
