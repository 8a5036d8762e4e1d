"""What decides how one picture becomes triangles."""

from dataclasses import dataclass, field

from stages.optimize_options import OptimizeOptions
from stages.spaces import SPACES
from stages.topology import TOPOLOGIES
from stages.topology.refine_options import RefineOptions
from warp_kernels.color_model import COLOR_MODELS, ColorModel
from warp_kernels.energy.sums import SUMS
from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class TriangulateOptions:
    """How one picture becomes triangles.

    Raises:
        OptionError: If an option has an impossible value.
    """

    color: str = field(
        default="constant",
        metadata={"help": "colour model that is optimised", "choices": tuple(COLOR_MODELS)},
    )
    iterations: int = field(
        default=240, metadata={"help": "optimiser iterations for the first frame of a shot"}
    )
    frame_iterations: int = field(
        default=48, metadata={"help": "most optimiser iterations for each later frame"}
    )
    topology: str = field(
        default="energy",
        metadata={
            "help": "flips that lower the energy, or the paper's Delaunay flips",
            "choices": tuple(TOPOLOGIES),
        },
    )
    sums: str = field(
        default="edges",
        metadata={"help": "how moments are summed; equal results", "choices": SUMS},
    )
    space: str = field(
        default="rgb",
        metadata={
            "help": "colour space in which the error is measured; colours are fitted in RGB",
            "choices": tuple(SPACES),
        },
    )
    keep_layout: float = field(
        default=0.0,
        metadata={
            "help": "hold vertices near where the layout, and then the motion, put them: 0 for "
            "free, 1 for the layout as it is"
        },
    )
    optimize: OptimizeOptions = field(default_factory=OptimizeOptions)
    refine: RefineOptions = field(default_factory=RefineOptions)

    def __post_init__(self) -> None:
        for name in ("iterations", "frame_iterations"):
            if getattr(self, name) < 0:
                flag = name.replace("_", "-")
                raise OptionError(f"--{flag} {getattr(self, name)}: must be 0 or more")
        if not 0.0 <= self.keep_layout <= 1.0:
            raise OptionError(
                f"--keep-layout {self.keep_layout:g}: must lie between 0 (free) and 1 (as laid)"
            )
        for name, known in (
            ("color", COLOR_MODELS),
            ("topology", TOPOLOGIES),
            ("sums", SUMS),
            ("space", SPACES),
        ):
            if getattr(self, name) not in known:
                raise OptionError(
                    f"--{name} {getattr(self, name)}: unknown; choose from {', '.join(known)}"
                )

    @property
    def model(self) -> ColorModel:
        """The colour model that is optimised."""
        return COLOR_MODELS[self.color]
