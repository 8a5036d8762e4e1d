"""The middle of the picture."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.focus.strength import Strength
from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

    from stages.frame import Frame

LINES = 64
"""Size of the map, whatever the picture's."""


@dataclass(frozen=True)
class Center(Strength):
    """Errors count more the nearer to the middle they are.

    Raises:
        OptionError: If a parameter is impossible.
    """

    size: float = field(
        default=0.25,
        metadata={
            "help": "distance from the middle at which 0.6 of it is left, as a part of the sides",
            "range": (0.02, 2.0),
        },
        kw_only=False,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.02 <= self.size <= 2.0:
            raise OptionError(f"size {self.size:g}: must lie between 0.02 and 2; try 0.25")

    def glance(self, before: "Frame | None", frame: "Frame") -> "np.ndarray":
        """A bump in the middle.

        Args:
            before: Not looked at.
            frame: Not looked at.

        Returns:
            [h, w] float32.
        """
        import numpy as np

        places = (np.arange(LINES, dtype=np.float32) + 0.5) / LINES - 0.5
        falling = np.exp(-0.5 * (places / np.float32(self.size)) ** 2)
        return np.outer(falling, falling).astype(np.float32)
