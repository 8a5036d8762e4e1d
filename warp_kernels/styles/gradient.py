"""Every triangle in a colour gradient."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Gradient(Style):
    """Linear colour gradients, and quadratic ones where such colours were optimised.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6c.
    Deviation: the paper has no quadratic colours.
    """

    degree: ClassVar[int] = 1
    shader = Imported("warp_kernels.styles.shaders.gradient:gradient_color")
    prepare = Imported("warp_kernels.styles.shaders.gradient:prepare_gradient")
