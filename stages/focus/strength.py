"""How much a focus adds to the weights of pixels."""

from dataclasses import dataclass, field

from warp_kernels.errors import OptionError

STRENGTHS = (0.0, 4.0)
"""Least and largest strength: beyond it the rest of the picture falls apart."""


@dataclass(frozen=True, kw_only=True)
class Strength:
    """What all members share.

    Raises:
        OptionError: If the strength is impossible.
    """

    strength: float = field(
        default=1.0,
        metadata={"help": "how much it adds; 0 for nothing", "range": STRENGTHS},
    )

    def __post_init__(self) -> None:
        least, largest = STRENGTHS
        if not least <= self.strength <= largest:
            raise OptionError(f"strength {self.strength:g}: must lie between 0 and {largest:g}")
