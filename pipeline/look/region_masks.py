"""The frames for which masks of followed regions were drawn: looked for before any is solved."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.solve_options import SolveOptions
from pipeline.track import TrackReader
from stages.masks.painted import painted
from stages.masks.region import Region
from stages.masks.regions import Mask
from stages.media import MediaInfo, count_frames, input_pattern, open_decoder
from warp_kernels.errors import MediaError, OptionError


def check_followed(job: Job, info: MediaInfo) -> None:
    """Find out before frames are solved whether their regions can be followed.

    Args:
        job: The job.
        info: Its source.

    Raises:
        OptionError: If a mask was drawn for a frame that will not be there.
        MediaError: If the source cannot be read.
        TrackError: If the track to go on with cannot be.
    """
    if not job.look.followed:
        return
    solved = _solved(job.output)
    for region in job.look.followed:
        check_dependent(region, job.solve)
        for frame in region.frames:
            problem = None if frame in solved else _problem(frame, job.solve, info)
            if problem is not None:
                raise OptionError(
                    f"--region {region.mask}@{frame}: {problem}; draw the mask for a frame that "
                    "is solved, or solve more and render a part of the track"
                )


def check_dependent(region: Region, options: SolveOptions) -> None:
    """Refuse to follow a region where nothing persists.

    Args:
        region: The region.
        options: Say how frames are solved.

    Raises:
        OptionError: If every frame is triangulated anew.
    """
    if options.independent:
        raise OptionError(
            f"--region {region.mask}@{region.frames[0]}: with --independent no triangle outlives "
            "its frame; give masks for all frames, without @"
        )


def own_mask(region: Region, frame: int, size: tuple[int, int]) -> np.ndarray:
    """The mask of a followed region for one of its frames.

    Args:
        region: The region.
        frame: Number of the frame.
        size: Width and height of the source, upright [px].

    Returns:
        White where the region is, [H, W] uint8.

    Raises:
        MediaError: If there is none for the frame, or it cannot be read.
    """
    if region.areas:
        return painted(region.areas, size)
    try:
        mask = Mask(region.mask, size, is_single=True)
        try:
            return mask.at(frame)
        finally:
            mask.close()
    except MediaError as error:
        named = f"--region {region.mask}@{frame}"
        if error.path != Path(region.mask):  # one of several stills
            named = f"{named}: {error.path}"
        raise MediaError(named, error.problem, error.remedy) from error


def _solved(output: Output) -> set[int]:
    """Frames that the track holds with which a job goes on."""
    if not output.resume or output.track is None or not output.track.exists():
        return set()
    with TrackReader(output.track) as track:
        return {row.frame for row in track.rows}


def _problem(frame: int, options: SolveOptions, info: MediaInfo) -> str | None:
    """Why a frame will not be solved, or None if it will."""
    wanted = options.frame_range
    is_there = wanted.first <= frame <= (frame if wanted.last is None else wanted.last)
    if not (is_there and wanted.is_in_step(frame)):
        return f"the frames {wanted} have no frame {frame}"
    available = _available_without(frame, options, info)
    if available is not None:
        return f"{options.source} has no frame {frame}, it has {available}"
    if not _is_in_time(frame, options):
        return f"frame {frame} lies outside of --start and --end"
    return None


def _available_without(frame: int, options: SolveOptions, info: MediaInfo) -> str | None:
    """What a source has instead of a frame, or None if it has that."""
    pattern = input_pattern(options.source)
    if pattern is not None:  # the number of stills says nothing about the numbers in their names
        numbers = pattern.numbers()
        return None if frame in numbers else f"stills {numbers[0]} to {numbers[-1]}"
    if info.frame_count is not None and frame < info.frame_count:
        return None
    count = count_frames(options.source, options.read)  # what the file declares is an estimate
    return None if frame < count else f"frames 0 to {count - 1}"


def _is_in_time(frame: int, options: SolveOptions) -> bool:
    """Whether a frame of the source lies between the times that are wanted."""
    wanted = options.frame_range
    if wanted.start_time is None and wanted.end_time is None:
        return True
    try:
        one = replace(wanted, first=frame, last=frame, step=1)
        with open_decoder(options.source, one, read=options.read) as decoder:
            return next(decoder, None) is not None
    except OptionError:  # the decoder has no such frame at these times
        return False
