"""Options as keywords: their types, for type checkers, and which function takes which.

A new option of the command line needs one line here; `tests/test_library.py` says where.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from os import PathLike
from typing import Any, TypedDict

from pipeline.options.command_line import COMMAND_OPTIONS, Option, job_options

Name = str | PathLike[str]
"""The name of a file."""


class RangeKeywords(TypedDict, total=False):
    """Which frames."""

    frames: str | int
    start: str | float
    end: str | float


class SourceKeywords(RangeKeywords, total=False):
    """Which frames, and how the source is read."""

    fps: str | float | Fraction | None
    page: int | None
    stream: int | None
    limits: str | None
    decoder: str


class DeviceKeywords(TypedDict, total=False):
    """Where kernels run."""

    device: str
    threads: int


class ShapeKeywords(DeviceKeywords, total=False):
    """How pictures become triangles."""

    seed: int
    layout: str
    focus: str | Sequence[str]
    color: str
    iterations: int
    keep_layout: float
    topology: str
    sums: str
    space: str
    regularity: float
    trust_region: float
    triangles: int
    error: float | None
    quality: float | None
    max_area: float | None


class PictureKeywords(ShapeKeywords, total=False):
    """How one picture becomes triangles; weights may be an array, edits a list."""

    weights: Any
    edits: Any


class AnimatorKeywords(ShapeKeywords, total=False):
    """How frames that follow each other become triangles."""

    weights: Name | None

    frame_iterations: int
    flow: str
    cuts: Name
    independent: bool


class SolveKeywords(AnimatorKeywords, SourceKeywords, total=False):
    """How a clip becomes triangles."""

    preset: Name | None
    timeline: Name | None
    loop: int
    beats: Name | None
    audio_mode: Name
    audio_offset: str | float
    edits: Any
    jobs: int
    cluster: str | None
    report: Name | None
    overwrite: bool
    resume: bool


class LookKeywords(TypedDict, total=False):
    """What triangles look like."""

    styles: str | Sequence[str]
    regions: str | Sequence[str]
    moves: str | Sequence[str]
    timeline: Name | None
    beats: Name | None
    palette: Name | None
    grade: str | None
    size: str | tuple[int, int] | None
    scale: float | None
    samples: int
    fit: str
    background: str | None
    blend: int
    smooth: float


class OutputKeywords(TypedDict, total=False):
    """How an output is written."""

    codec: str | None
    crf: int | None
    pixel_format: str | None
    encoder_preset: str | None
    audio: bool
    audio_mode: Name
    audio_offset: str | float
    report: Name | None
    overwrite: bool
    svg_precision: int
    svg_merge: bool
    svg_gradients: str
    mm: float
    relief: str | None
    lottie_limit: int
    usd_single: bool


class RenderKeywords(RangeKeywords, LookKeywords, OutputKeywords, DeviceKeywords, total=False):
    """How a mesh track is drawn."""

    preset: Name | None


class AnimateKeywords(SolveKeywords, LookKeywords, OutputKeywords, total=False):
    """How a clip becomes another one."""

    track: Name | None


class DrawKeywords(DeviceKeywords, total=False):
    """How one frame is drawn."""

    styles: str | Sequence[str]
    moves: str | Sequence[str]
    palette: Name | None
    grade: str | None
    size: str | tuple[int, int] | None
    scale: float | None
    samples: int
    fit: str
    background: str | None


class SaveKeywords(DeviceKeywords, total=False):
    """How one frame is written as shapes."""

    palette: Name | None
    grade: str | None
    size: str | tuple[int, int] | None
    scale: float | None
    fit: str
    background: str | None
    overwrite: bool
    svg_precision: int
    svg_merge: bool
    svg_gradients: str
    mm: float
    relief: str | None
    lottie_limit: int
    usd_single: bool


def keyword_of(option: Option) -> str:
    """The keyword of an option: what can be repeated is a list and has the name of one.

    Args:
        option: An option of the command line.
    """
    if option.is_repeatable or option.is_switch or option.dest == "audio_mode":
        return option.dest  # audio=False is --no-audio, so --audio has another name
    return option.flag.replace("-", "_")


def options_of(function: str) -> dict[str, Option]:
    """The options that a function takes, by keyword.

    Args:
        function: Its name, such as `animate`.
    """
    wanted = TAKEN[function]
    return {keyword_of(option): option for option in job_options() if wanted(option)}


def _for_pictures(option: Option) -> bool:
    """Whether an option says how one picture becomes triangles."""
    described = option.group == "triangles" and option.dest != "frame_iterations"
    return described or option.dest in ("seed", "device", "threads")


DRAWN = (
    *("styles", "moves", "palette", "grade", "output_size", "scale", "samples", "fit"),
    "background",
    *("device", "threads"),
)
"""Options that say how one frame is drawn."""

SAVED = (
    *("palette", "grade", "output_size", "scale", "fit", "background", "overwrite"),
    *("svg_precision", "svg_merge", "svg_gradients", "mm", "relief", "lottie_limit"),
    *("usd_single", "device", "threads"),
)
"""Options that say how one frame is written as shapes, beside its styles."""

TAKEN: dict[str, Callable[[Option], bool]] = {
    **{name: COMMAND_OPTIONS[name] for name in ("animate", "solve", "render", "measure")},
    "triangulate": lambda option: _for_pictures(option) or option.dest == "edits",
    "Animator": lambda option: (
        option.dest != "edits"
        and (_for_pictures(option) or option.group in ("triangles", "motion"))
    ),
    "draw": lambda option: option.dest in DRAWN,
    "save": lambda option: option.dest in SAVED,
}
"""Which options a function takes."""

KEYWORDS: dict[str, Any] = {
    "animate": AnimateKeywords,
    "solve": SolveKeywords,
    "render": RenderKeywords,
    "measure": RangeKeywords,
    "triangulate": PictureKeywords,
    "Animator": AnimatorKeywords,
    "draw": DrawKeywords,
    "save": SaveKeywords,
}
"""Their types."""

PRESET = frozenset({"animate", "solve", "render"})
"""Functions that take a preset besides."""
