"""What decides how shapes are written."""

from dataclasses import dataclass, field, fields
from functools import cached_property

from stages.exchange.relief import Relief
from warp_kernels.errors import OptionError

MAX_PRECISION = 6
"""Decimals; more than positions have."""

MAX_WIDTH = 10_000
"""Millimetres; more than plotters have."""
GRADIENTS = ("exact", "plain")
"""How linear colours can be written."""
USD = (".usd", ".usda", ".usdc")
"""Endings of USD."""


@dataclass(frozen=True)
class ExchangeOptions:
    """How shapes are written.

    Raises:
        OptionError: If an option has an impossible value.
    """

    svg_precision: int = field(
        default=2,
        metadata={
            "help": "decimals of positions in .svg: 2 is off by 0.005 px at most",
            "endings": (".svg",),
        },
    )
    """Decimals of positions."""
    svg_merge: bool = field(
        default=False,
        metadata={
            "help": "make one path of neighbours that have the same colour in .svg and .dxf",
            "endings": (".svg", ".dxf"),
        },
    )
    """Whether neighbours of one colour become one path."""

    svg_gradients: str = field(
        default="exact",
        metadata={
            "help": "gradients in .svg: exact adds up three layers, one for each channel, plain is "
            "the nearest single gradient",
            "choices": GRADIENTS,
            "endings": (".svg",),
        },
    )
    """How linear colours are written."""

    mm: float = field(
        default=0.0,
        metadata={
            "help": "width of .svg and .dxf in millimetres, for plotters and cutters; 0 for a size "
            "in pixels, each a millimetre in .dxf",
            "metavar": "MM",
            "endings": (".svg", ".dxf"),
        },
    )
    """Width of the output on paper [mm], or 0."""
    relief: str | None = field(
        default=None,
        metadata={
            "help": "brightness, or a picture of depth, as height in 3D formats: from black to "
            "white so many of the picture's longer side",
            "metavar": "X[:FILE]",
            "endings": (".glb", ".obj", ".ply", *USD),
        },
    )
    """Heights in 3D formats, as `Relief.parse` reads them; None for flat ones."""

    lottie_limit: int = field(
        default=500,
        metadata={
            "help": "most triangles of a frame in .json; players become slow beyond",
            "endings": (".json",),
        },
    )
    """Most triangles of a frame in Lottie."""

    usd_single: bool = field(
        default=False,
        metadata={
            "help": "one mesh in .usd, whose triangles change in time, instead of one for each run "
            "of frames in which none comes or goes; for programs that can read it",
            "endings": USD,
        },
    )
    """Whether USD has one mesh for the whole clip."""

    @cached_property
    def heights(self) -> Relief | None:
        """The relief that is wanted, or None."""
        return None if self.relief is None else Relief.parse(self.relief)

    def __post_init__(self) -> None:
        _ = self.heights
        if self.lottie_limit < 1:
            raise OptionError(f"--lottie-limit {self.lottie_limit}: must be at least 1")
        if not 0 <= self.svg_precision <= MAX_PRECISION:
            raise OptionError(
                f"--svg-precision {self.svg_precision}: must lie between 0 and {MAX_PRECISION}"
            )
        if self.mm != 0.0 and not 1.0 <= self.mm <= MAX_WIDTH:
            raise OptionError(
                f"--mm {self.mm:g}: must lie between 1 and {MAX_WIDTH}, or be 0, a size in pixels"
            )
        if self.svg_gradients not in GRADIENTS:
            raise OptionError(
                f"--svg-gradients {self.svg_gradients}: choose from {', '.join(GRADIENTS)}"
            )

    def refuse_idle(self, ending: str) -> None:
        """Refuse options that change nothing of an output: who gives them means another one.

        Args:
            ending: That of the output, in lower case, with its dot.

        Raises:
            OptionError: If there is one.
        """
        for option in fields(self):
            known = option.metadata["endings"]
            if ending not in known and getattr(self, option.name) != option.default:
                *others, last = known
                named = f"{', '.join(others)} and {last}" if others else last
                raise OptionError(
                    f"--{option.name.replace('_', '-')}: means nothing in {ending or 'it'}, only "
                    f"in {named}; leave it out"
                )
