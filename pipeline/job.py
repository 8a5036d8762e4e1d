"""Everything that one run of `animate` or `solve` needs, checked and with every default filled in.

The options of the command line are the fields of `Job`, and of the dataclasses inside it, that
carry `help`: their defaults, help and choices stand there and nowhere else. Metadata of a field:

    help       what it does; a field without is not an option
    choices    the values that it may have
    metavar    how its value is shown in the help
    flag       its name on the command line, if not its own name with dashes
    registry   the registry whose members it names, as module:NAME
    group      the heading in the help, if not that of its dataclass
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

from stages.flows import Flow
from stages.flows.dis import Dis
from stages.focus import Focus, resolved
from stages.focus.picture import Picture
from stages.layouts import Layout
from stages.layouts.importance import Importance
from stages.masks.regions import Region
from stages.media import EncodeOptions, FrameRange, ReadOptions
from stages.triangulate import TriangulateOptions
from warp_kernels.energy.color_model import CONSTANT, LINEAR, ColorModel
from warp_kernels.errors import OptionError
from warp_kernels.raster import MAX_SIDE
from warp_kernels.styles import Flat, Gradient, Style

MAX_THREADS = 1024
"""More than any machine has cores; beyond it a number is a mistake."""
MAX_BLEND = 250
"""Frames; ten seconds. What fades must be kept in memory."""
MAX_SMOOTH = 50
"""Frames; three times as many on either side are kept in memory."""

_DEVICE = re.compile(r"auto|cpu|cuda(:\d+)?")


@dataclass(frozen=True)
class Job:
    """One run: a source, an output and how the one becomes the other.

    Raises:
        OptionError: If an option has an impossible value.
    """

    source: Path
    """What is converted: a video, a still or a pattern of numbered stills."""
    output: Path
    """What is written."""
    frame_range: FrameRange = field(default_factory=FrameRange)
    """The frames of the source that are converted."""
    read: ReadOptions = field(default_factory=ReadOptions)
    """How the source is read."""
    device: str = field(
        default="auto",
        metadata={"help": "where kernels run", "metavar": "auto|cpu|cuda:N"},
    )
    """`auto`, `cpu` or `cuda:N`."""
    threads: int = field(default=0, metadata={"help": "threads of the CPU, 0 for one per core"})
    """Threads of the CPU, 0 for one per core."""
    seed: int = field(default=0, metadata={"help": "seed of all randomness"})
    """Seed of all randomness."""
    layout: Layout = field(
        default_factory=Importance,
        metadata={
            "help": "first mesh of a shot; importance takes a grey picture: importance:MAP.png",
            "registry": "stages.layouts:LAYOUTS",
            "group": "triangles",
        },
    )
    """Makes the first mesh of a shot."""
    flow: Flow = field(
        default_factory=Dis,
        metadata={
            "help": "how motion between frames is estimated",
            "registry": "stages.flows:FLOWS",
            "group": "motion",
        },
    )
    """Estimates the motion between frames."""
    weights: str | None = field(
        default=None,
        metadata={
            "help": "grey picture, numbered stills or video of the source's size: errors count "
            "most where it is white, a 255th of that where it is black",
            "metavar": "MAP",
            "group": "triangles",
        },
    )
    """Where errors count more: a still for all frames, or a clip with a picture for each."""
    focus: tuple[Focus, ...] = field(
        default=(),
        metadata={
            "help": "where errors count more, repeatable, what several add is summed: faces, "
            "saliency, motion, center, picture:FILE (as --weights), none for nowhere, auto for "
            "faces where there are any (default: auto)",
            "registry": "stages.focus:FOCI",
            "group": "triangles",
        },
    )
    """Where errors count more; empty for `auto`, or for nothing beside `weights`."""
    triangulate: TriangulateOptions = field(default_factory=TriangulateOptions)
    """How one picture becomes triangles."""
    styles: tuple[Style, ...] = field(
        default=(),
        metadata={
            "help": "look of the triangles, repeatable from bottom to top "
            "(default: flat, or gradient with --color linear)",
            "registry": "warp_kernels.styles:STYLES",
            "flag": "style",
            "group": "look",
        },
    )
    """Looks, bottom to top; empty for the one that suits the colour model."""
    regions: tuple[Region, ...] = field(
        default=(),
        metadata={
            "help": "a style inside of a mask, over the others, repeatable: a still, numbered "
            "stills or a video of the source's size, white where the style is drawn; "
            "MASK@FRAME,FRAME,...:STYLE follows what it shows in these frames through their shots",
            "metavar": "MASK[@FRAME]:STYLE",
            "flag": "region",
            "group": "look",
        },
    )
    """Styles inside of masks, over `styles`, bottom to top."""
    output_size: tuple[int, int] | None = field(
        default=None,
        metadata={
            "help": "size of the output (default: the source's)",
            "metavar": "WxH",
            "flag": "size",
            "group": "look",
        },
    )
    """Width and height of the output [px], or None."""
    scale: float | None = field(
        default=None,
        metadata={"help": "size of the output relative to the source", "group": "look"},
    )
    """Size of the output relative to the source, or None."""
    blend: int = field(
        default=0,
        metadata={
            "help": "frames over which triangles fade in where they replace others, 0 for at once",
            "group": "look",
        },
    )
    """Most frames over which new triangles fade in."""
    smooth: float = field(
        default=0.0,
        metadata={
            "help": "smooth paths and colours over time: standard deviation in frames, 0 for not",
            "group": "look",
        },
    )
    """Standard deviation of the smoothing over time [frames]."""
    encode: EncodeOptions = field(default_factory=EncodeOptions)
    """How the output is written."""
    cuts: str = field(
        default="auto",
        metadata={
            "help": "where a new shot starts: auto finds hard cuts, none ignores them, a file "
            "lists the first frames of the shots (JSON or one number a line)",
            "metavar": "auto|none|FILE",
            "group": "motion",
        },
    )
    """`auto`, `none`, or a file with the first frames of new shots."""
    independent: bool = field(
        default=False,
        metadata={
            "help": "triangulate every frame from scratch (flickers; for comparison)",
            "group": "motion",
        },
    )
    """Whether every frame starts from a new layout."""
    track: Path | None = field(
        default=None,
        metadata={
            "help": "also write the mesh track, from which other looks can be drawn",
            "metavar": "FILE.mtrk",
            "group": "output",
        },
    )
    """The mesh track that is written, or None."""
    resume: bool = field(
        default=False,
        metadata={
            "help": "go on with the track of an interrupted job, to the same bits",
            "group": "output",
        },
    )
    """Whether to go on with the track if there is one."""
    jobs: int = field(
        default=1, metadata={"help": "processes, each for whole shots", "group": "processes"}
    )
    """Number of processes."""

    def __post_init__(self) -> None:
        if self.output_size is not None and self.scale is not None:
            raise OptionError("--size and --scale exclude each other; give one of them")
        if self.output_size is not None:
            check_output_size(self.output_size, "--size {}x{}".format(*self.output_size))
        if self.scale is not None and not 0 < self.scale <= MAX_SIDE:
            raise OptionError(
                f"--scale {self.scale:g}: must be above 0 and at most {MAX_SIDE}; try 2"
            )
        if not _DEVICE.fullmatch(self.device):
            raise OptionError(f"--device {self.device}: unknown; use auto, cpu or cuda:N")
        if not 0 <= self.threads <= MAX_THREADS:
            raise OptionError(
                f"--threads {self.threads}: must lie between 0 (one per core) and {MAX_THREADS}"
            )
        if self.seed < 0:
            raise OptionError(f"--seed {self.seed}: must be 0 or more")
        if not 0 <= self.blend <= MAX_BLEND:
            raise OptionError(f"--blend {self.blend}: must lie between 0 (off) and {MAX_BLEND}")
        if not 0 <= self.smooth <= MAX_SMOOTH:
            raise OptionError(
                f"--smooth {self.smooth:g}: must lie between 0 (off) and {MAX_SMOOTH}"
            )
        resolved(self.focus, self.weights)
        if not 1 <= self.jobs <= MAX_THREADS:
            raise OptionError(f"--jobs {self.jobs}: must lie between 1 and {MAX_THREADS}")

    @property
    def foci(self) -> tuple[Focus, ...]:
        """Where errors count more: the members that are at work, `weights` among them."""
        return resolved(self.focus, self.weights)

    @property
    def maps(self) -> tuple[Picture, ...]:
        """The members of `foci` that are pictures of the user's."""
        return tuple(member for member in self.foci if isinstance(member, Picture))

    @property
    def shown_styles(self) -> tuple[Style, ...]:
        """Looks, bottom to top; the one that shows the optimised colours if none is chosen."""
        plain = Gradient() if self.triangulate.model.degree > 0 else Flat()
        return self.styles or (plain,)

    @property
    def fitted(self) -> ColorModel:
        """The colour model of the snapshots: the optimised one, or what a look needs beyond."""
        drawn = LINEAR if any(style.degree > 0 for style in self._all_styles) else CONSTANT
        return max(self.triangulate.model, drawn, key=lambda model: model.degree)

    @property
    def lays_strokes(self) -> bool:
        """Whether a look has strokes that go on from frame to frame: all of a shot is needed.

        Where every frame starts anew, triangles have nothing in common.
        """
        return not self.independent and any(style.lays_strokes for style in self._all_styles)

    @property
    def needs_source(self) -> bool:
        """Whether a look shows the source picture."""
        return any(style.needs_source for style in self._all_styles)

    @property
    def followed(self) -> tuple[Region, ...]:
        """Regions that stay with their triangles."""
        return tuple(region for region in self.regions if region.frames)

    @property
    def unfollowed(self) -> tuple[Region, ...]:
        """Regions whose masks say for every frame where they are."""
        return tuple(region for region in self.regions if not region.frames)

    @property
    def _all_styles(self) -> tuple[Style, ...]:
        """Looks of the whole picture and of regions."""
        return (*self.shown_styles, *(region.style for region in self.regions))

    def size_for(self, source_size: tuple[int, int]) -> tuple[int, int]:
        """Size of the output for a source.

        Args:
            source_size: Width and height of the source, upright [px].

        Returns:
            Width and height [px].

        Raises:
            OptionError: If a scaled source has no pixel or too many.
        """
        if self.output_size is not None:
            return self.output_size
        if self.scale is None:
            return source_size
        width, height = (round(side * self.scale) for side in source_size)
        what = f"--scale {self.scale:g} makes {width}x{height} of {source_size[0]}x{source_size[1]}"
        check_output_size((width, height), what)
        return width, height


def check_output_size(size: tuple[int, int], what: str) -> None:
    """Refuse sizes that no output can have.

    Args:
        size: Width and height [px].
        what: The option, for the message.

    Raises:
        OptionError: If a side is below 1 or beyond `MAX_SIDE`.
    """
    if not 1 <= min(size) <= max(size) <= MAX_SIDE:
        raise OptionError(f"{what}: sides must lie between 1 and {MAX_SIDE} pixels")
