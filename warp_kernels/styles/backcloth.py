"""What is seen behind triangles that move: no style that a user names."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Backcloth(Style):
    """A picture that was drawn before."""

    shader = Imported("warp_kernels.styles.shaders.backcloth:backcloth_color")
    stays: ClassVar[bool] = True
