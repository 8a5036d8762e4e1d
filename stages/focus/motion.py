"""What moves in another way than the picture as a whole."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.focus.strength import Strength
from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

    from stages.frame import Frame


@dataclass(frozen=True)
class Motion(Strength):
    """Errors count more on what moves against the motion of the whole picture.

    Raises:
        OptionError: If a parameter is impossible.
    """

    speed: float = field(
        default=0.008,
        metadata={
            "help": "motion beside that of the whole that counts fully, in short sides of the "
            "picture a frame",
            "range": (0.001, 0.2),
        },
        kw_only=False,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.001 <= self.speed <= 0.2:
            raise OptionError(f"speed {self.speed:g}: must lie between 0.001 and 0.2; try 0.008")

    def glance(self, before: "Frame | None", frame: "Frame") -> "np.ndarray":
        """Motion from the frame before, beside the dominant one.

        Args:
            before: The frame before in the shot; None for no motion.
            frame: The picture.

        Returns:
            [h, w] float32, 0 to 1.
        """
        from stages.focus.own_motion import own_motion

        return own_motion(before, frame, self.speed)
