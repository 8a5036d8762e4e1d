"""What decides how many triangles there are, and where."""

import math
from dataclasses import dataclass, field

from warp_kernels.errors import OptionError

SMALLEST_LIMIT = 8.0
"""The largest area may not be less than this [px^2]: smaller triangles show pixels."""
SLACK = 2.0
"""Triangles that cover a picture under a limit of area, as a multiple of the fewest possible: what
exceeds them serves the picture."""


@dataclass(frozen=True)
class RefineOptions:
    """How many triangles, and where.

    Raises:
        OptionError: If a target cannot be met.
    """

    triangles: int = field(
        default=1500, metadata={"help": "number of triangles, worst errors split first"}
    )
    error: float | None = field(
        default=None,
        metadata={
            "help": "split while sqrt(E(T)/|I|) of a triangle exceeds this [code values]; "
            "--triangles then only caps"
        },
    )
    quality: float | None = field(
        default=None,
        metadata={
            "help": "as few triangles as reach this root mean square error per channel "
            "[code values], instead of --triangles",
            "metavar": "RMSE",
        },
    )
    max_area: float | None = field(
        default=None,
        metadata={"help": "no triangle is larger than this [px^2]", "metavar": "PX"},
    )

    def __post_init__(self) -> None:
        if self.triangles < 2:
            raise OptionError(f"--triangles {self.triangles}: a picture has two or more; try 1500")
        if self.error is not None and not self.error > 0:
            raise OptionError(f"--error {self.error:g}: must be above 0; try 0.5")
        if self.quality is not None and not 0 < self.quality < 256:
            raise OptionError(f"--quality {self.quality:g}: must lie between 0 and 256; try 12")
        if self.quality is not None and self.error is not None:
            raise OptionError("--quality and --error exclude each other; give one of them")
        if self.max_area is not None and not self.max_area >= SMALLEST_LIMIT:
            raise OptionError(
                f"--max-area {self.max_area:g}: must be {SMALLEST_LIMIT:g} or more; try 2000"
            )

    @property
    def most(self) -> int | None:
        """Triangles of a picture, if it is not the picture that decides; held ones come on top."""
        return self.triangles if self.error is None and self.quality is None else None

    @property
    def largest_area(self) -> float:
        """Area that no triangle may exceed [px^2]."""
        return math.inf if self.max_area is None else self.max_area

    def least_count(self, width: int, height: int) -> int:
        """Fewest triangles that cover a picture [px] and still can follow it.

        Raises:
            OptionError: If `triangles` are fewer.
        """
        least = max(2, math.ceil(SLACK * width * height / self.largest_area))
        if self.quality is None and self.triangles < least:
            raise OptionError(
                f"--max-area {self.max_area:g}: {self.triangles} triangles are too few to cover "
                f"{width}x{height}; ask for --triangles {least} or more, or a larger area"
            )
        return least
