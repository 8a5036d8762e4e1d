"""A picture of the user's, or one for every frame."""

from dataclasses import dataclass, field

from stages.focus.strength import Strength
from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class Picture(Strength):
    """Errors count as a grey picture says: white fully, black a 255th.

    Its strength is an exponent: 0.5 takes the roots of the weights.

    Raises:
        OptionError: If no picture is named.
    """

    file: str | None = field(
        default=None,
        metadata={"help": "grey still, numbered stills or video of the source's size"},
        kw_only=False,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.file:
            raise OptionError("no picture is named; write picture:FILE")
