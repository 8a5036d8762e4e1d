"""Colour spaces in which the error is measured: `SPACES` names them for the command line.

A space is a frozen dataclass with one method `convert(pixels [H, W, 3] uint8) -> [H, W, 3] uint8`
from a frame's full-range RGB to code values of the space. They are integers from 0 to 255 like
those of the picture, so every sum stays exact and every bound of the kernels holds; energies,
`--error` and all that is weighed against them are in code values of the space. The colours that
are drawn are fitted in RGB whatever the space. A new space is a file and a line here.
"""

from typing import TYPE_CHECKING, ClassVar, Protocol

from warp_kernels.registry import Registry

if TYPE_CHECKING:
    import numpy as np


class Space(Protocol):
    """What every member of `SPACES` can do."""

    scale: ClassVar[float]
    """Energy of an error in this space over that of the same error in RGB, typically [1]."""

    def convert(self, pixels: "np.ndarray") -> "np.ndarray":
        """Turn a picture into code values of the space, both [H, W, 3] uint8."""
        ...


SPACES: Registry[Space] = Registry(
    "spaces",
    {
        "rgb": "stages.spaces.rgb:Rgb",
        "oklab": "stages.spaces.oklab:Oklab",
        "luma": "stages.spaces.luma:Luma",
    },
)
