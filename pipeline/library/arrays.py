"""Frames that come as arrays, solved as those of a clip are."""

from collections.abc import Iterator, Mapping
from typing import Any

from pipeline.envelope import Solved
from pipeline.job import Job
from pipeline.library.given import given_values
from pipeline.library.triangulation import Origin, Triangulation
from pipeline.loop.animate import prepared, solved_frames
from pipeline.loop.attention import Attention
from pipeline.options.build import build_job
from stages.frame import Frame
from stages.masks.weight_maps import WeightMap
from stages.media import MediaInfo
from stages.triangulate import Triangulator


def job_without_files(function: str, options: Mapping[str, Any]) -> Job:
    """The job that a call describes.

    Args:
        function: What was called.
        options: Its keywords.

    Raises:
        OptionError: If there is no such option, or its value is impossible.
    """
    return build_job({"source": "", "output": "", **given_values(function, options)})


def solved_arrays(
    frames: Iterator[Frame], job: Job, triangulator: Triangulator, info: MediaInfo
) -> Iterator[Solved]:
    """Solve frames as those of a clip; files that options name are looked at before the first.

    Args:
        frames: The frames, in order.
        job: Says how they are solved.
        triangulator: Made for the job.
        info: Their size and kind.

    Raises:
        MediaError: If a file that an option names cannot be read.
    """
    size = (info.width, info.height)
    attention = Attention(job.foci, info, 1, job.triangulate.refine.triangles)
    maps = [WeightMap(str(m.file), size, job.frame_range, m.strength) for m in job.maps]
    found = prepared(frames, info, attention, maps, job, None, [])
    return solved_frames(found, triangulator, job, None)


def told(solved: Solved, frame: Frame, job: Job) -> Triangulation:
    """What the caller sees of a frame.

    Args:
        solved: What it became.
        frame: The frame.
        job: Says how it was solved.
    """
    origin = Origin(
        color=job.triangulate.color,
        shot=solved.shot,
        frame=frame,
        device=job.device,
        threads=job.threads,
    )
    return Triangulation(solved.snapshot, origin)
