"""What decides a mesh: the source, the frames, and how they become triangles.

A track stores these options, and `--resume` and `join` compare them.
"""

import os
from dataclasses import dataclass, field
from pathlib import Path

from pipeline.options.course import Course
from pipeline.options.edit_log import EditLog
from pipeline.options.seam import Seam
from stages.flows import FLOWS, Flow
from stages.flows.dis import Dis
from stages.focus import FOCI, Focus, resolved
from stages.focus.picture import Picture
from stages.layouts import LAYOUTS, Layout
from stages.layouts.importance import Importance
from stages.media.frame_range import FrameRange
from stages.media.reading.read_options import ReadOptions
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError

MAX_LOOP = 120
"""Frames. So many pictures wait in memory until they are blended."""


@dataclass(frozen=True)
class SolveOptions:
    """How a source becomes meshes.

    Raises:
        OptionError: If an option has an impossible value.
    """

    source: Path
    """What is converted: a video, a still or a pattern of numbered stills."""
    frame_range: FrameRange = field(default_factory=FrameRange)
    """The frames of the source that are converted."""
    read: ReadOptions = field(default_factory=ReadOptions)
    """How the source is read."""
    seed: int = field(default=0, metadata={"help": "seed of all randomness", "group": "run"})
    """Seed of all randomness."""
    layout: Layout = field(
        default_factory=Importance,
        metadata={
            "help": "first mesh of a shot; importance takes a grey picture: importance:MAP.png, "
            "points x and y a line: points:FILE.csv",
            "registry": LAYOUTS,
        },
    )
    """Makes the first mesh of a shot."""
    flow: Flow = field(
        default_factory=Dis,
        metadata={
            "help": "how motion between frames is estimated",
            "registry": FLOWS,
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
        },
    )
    """Where errors count more: a still for all frames, or a clip with a picture for each."""
    focus: tuple[Focus, ...] = field(
        default=(),
        metadata={
            "help": "where errors count more, repeatable, what several add is summed: faces, "
            "saliency, motion, center, picture:FILE (as --weights), none for nowhere, auto for "
            "faces where there are any (default: auto)",
            "registry": FOCI,
            "metavar": "SPEC",
        },
    )
    """Where errors count more; empty for `auto`, or for nothing beside `weights`."""
    triangulate: TriangulateOptions = field(default_factory=TriangulateOptions)
    """How one picture becomes triangles."""
    course: Course = field(default_factory=Course)
    """What of this changes in the course of the film."""
    edits: EditLog | None = field(
        default=None,
        metadata={
            "help": "edits by hand, one a line as JSON, or the track that holds them; each reaches "
            "through its shot",
            "metavar": "LOG.jsonl",
            "group": "motion",
        },
    )
    """What a person did to meshes by hand, or None."""
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

    loop: int = field(
        default=0,
        metadata={
            "help": "close the film to a loop: frames over which its end is blended into its "
            "beginning, such as 12; 0 for not",
            "group": "time",
        },
    )
    """Frames over which the end of a loop is blended into its beginning; 0 for no loop."""
    seam: Seam = field(default_factory=Seam)
    """How the loop is closed, once that is known."""

    def __post_init__(self) -> None:
        if not 0 <= self.loop <= MAX_LOOP:
            raise OptionError(f"--loop {self.loop}: must lie between 0 (no loop) and {MAX_LOOP}")
        if self.seed < 0:
            raise OptionError(f"--seed {self.seed}: must be 0 or more")
        if self.cuts not in ("auto", "none") and not os.path.isfile(self.cuts):
            raise OptionError(
                f"--cuts {self.cuts}: no such file; give auto, none or a file of frame numbers"
            )
        resolved(self.focus, self.weights)
        if self.edits is not None and self.edits.edits:
            self._check_edits()

    def _check_edits(self) -> None:
        """Refuse options with which edits cannot reach through a shot."""
        if self.independent:
            raise OptionError(
                "--edits: with --independent no triangle outlives its frame; leave one of them out"
            )
        if self.triangulate.topology == "delaunay":
            raise OptionError(
                "--edits: --topology delaunay holds nothing fast; take --topology energy"
            )

    @property
    def foci(self) -> tuple[Focus, ...]:
        """Where errors count more: the members that are at work, `weights` among them."""
        return resolved(self.focus, self.weights)

    @property
    def maps(self) -> tuple[Picture, ...]:
        """The members of `foci` that are pictures of the user's."""
        return tuple(member for member in self.foci if isinstance(member, Picture))

    @property
    def model(self) -> ColorModel:
        """The colour model that is optimised."""
        return self.triangulate.model
