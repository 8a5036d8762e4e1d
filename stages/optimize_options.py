"""What decides how vertices move."""

import math
from dataclasses import dataclass, field

from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class OptimizeOptions:
    """How vertices move.

    Raises:
        OptionError: If a value is impossible.
    """

    regularity: float = field(
        default=1e-3, metadata={"help": "lambda: pull towards the ring's centre"}
    )
    trust_region: float = field(
        default=0.5, metadata={"help": "longest step of a vertex in one iteration [px]"}
    )

    def __post_init__(self) -> None:
        if not (math.isfinite(self.regularity) and self.regularity >= 0):
            raise OptionError(f"--regularity {self.regularity:g}: must be 0 or more; try 0.001")
        if not (math.isfinite(self.trust_region) and self.trust_region > 0):
            raise OptionError(f"--trust-region {self.trust_region:g}: must be above 0; try 0.5")
