"""Every triangle in its mean colour."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Flat(Style):
    """Constant colours.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6b.
    """

    shader = Imported("warp_kernels.styles.shaders.flat:flat_color")
    is_even: ClassVar[bool] = True
