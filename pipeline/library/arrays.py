"""Frames that come as arrays, solved as those of a clip are."""

from collections.abc import Iterator, Mapping
from typing import Any

from pipeline.envelope import Solved
from pipeline.library.given import given_values
from pipeline.library.triangulation import Origin, Triangulation
from pipeline.loop.attention import Attention
from pipeline.loop.convert import solved_frames
from pipeline.loop.prepare import prepared
from pipeline.options.build import fill, values_of
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from stages.frame import Frame
from stages.masks.weight_maps import WeightMap
from stages.media import MediaInfo
from stages.triangulate import Triangulator

ARRAYS = "arrays"
"""In place of a source's name: frames come from a program."""


def options_of_arrays(function: str, options: Mapping[str, Any]) -> tuple[SolveOptions, Run]:
    """How a call wants its arrays solved.

    Args:
        function: What was called.
        options: Its keywords.

    Raises:
        OptionError: If there is no such option, or its value is impossible.
    """
    values = values_of({"source": ARRAYS, **given_values(function, options)})
    return fill(SolveOptions, values), fill(Run, values)


def solved_arrays(
    frames: Iterator[Frame], options: SolveOptions, triangulator: Triangulator, info: MediaInfo
) -> Iterator[Solved]:
    """Solve frames as those of a clip; files that options name are looked at before the first.

    Args:
        frames: The frames, in order.
        options: Say how they are solved.
        triangulator: Made for them.
        info: Their size and kind.

    Raises:
        MediaError: If a file that an option names cannot be read.
    """
    size = (info.width, info.height)
    attention = Attention(options.foci, info, 1, options.triangulate.refine.triangles)
    maps = [WeightMap(str(m.file), size, options.frame_range, m.strength) for m in options.maps]
    found = prepared(frames, info, attention, maps, options, None, [])
    return solved_frames(found, triangulator, options, None)


def told(solved: Solved, frame: Frame, options: SolveOptions, run: Run) -> Triangulation:
    """What the caller sees of a frame.

    Args:
        solved: What it became.
        frame: The frame.
        options: Say how it was solved.
        run: Says where.
    """
    origin = Origin(
        color=options.triangulate.color,
        shot=solved.shot,
        frame=frame,
        device=run.device,
        threads=run.threads,
    )
    return Triangulation(solved.snapshot, origin)
