"""The source picture itself."""

from dataclasses import dataclass
from typing import ClassVar

from warp_kernels.registry import Imported
from warp_kernels.styles.style import Style


@dataclass(frozen=True)
class Source(Style):
    """The original, to see through other styles or to draw on.

    Deviation: the paper draws its styles on flat grounds.
    """

    shader = Imported("warp_kernels.styles.shaders.source:source_color")
    needs_source: ClassVar[bool] = True
