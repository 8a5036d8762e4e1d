"""Regions that stay with their triangles, over the frames of a track."""

from collections.abc import Iterator, Sequence

import numpy as np

from pipeline.job import Job
from pipeline.track import FrameRow, TrackReader
from stages.following import inherited, under_mask
from stages.media import MediaInfo
from stages.regions import Mask, Region
from warp_kernels.errors import OptionError

MEMBER = 255
"""Share of a triangle that belongs to a region."""


def followed_shares(
    job: Job, track: TrackReader, rows: Sequence[FrameRow]
) -> Iterator[np.ndarray | None]:
    """Which triangles the followed regions of a job hold.

    They are followed through all frames between the one that the mask was drawn for and the one
    that is asked for: a part of a track looks as it does in the whole.

    Args:
        job: Has the regions.
        track: The whole track.
        rows: Frames of it, in order.

    Yields:
        For every frame `Paint.shares` [T, R] uint8, or None if the job follows no region.

    Raises:
        OptionError: If the track has no such frame, or its frames have nothing in common.
        MediaError: If a mask cannot be read.
        TrackError: If the track is damaged.
    """
    regions = job.followed
    if not regions:
        yield from (None for _ in rows)
        return
    members = [_members(region, job, track, rows) for region in regions]
    for row in rows:
        columns = [of_frame.get(row.frame) for of_frame in members]
        blank = np.zeros(row.triangle_count, dtype=bool)
        shares = np.stack([blank if c is None else c for c in columns], axis=1)
        yield MEMBER * shares.astype(np.uint8)


def check_followed(job: Job, info: MediaInfo) -> None:
    """Find out before frames are solved whether their regions can be followed.

    Args:
        job: The job.
        info: Its source.

    Raises:
        OptionError: If a mask was drawn for a frame that will not be there.
    """
    goes_on = job.resume and job.track is not None and job.track.exists()
    wanted = job.frame_range
    for region in job.followed:
        _check_dependent(region, job)
        frame = region.drawn_for
        is_there = wanted.first <= frame <= (frame if wanted.last is None else wanted.last)
        is_there &= wanted.is_in_step(frame)
        is_there &= info.frame_count is None or frame < info.frame_count
        if not (is_there or goes_on):
            raise OptionError(
                f"--region {region.mask}@{frame}: the frames {wanted} have no frame {frame}; draw "
                "the mask for one of them, or solve more frames and render a part of the track"
            )


def _check_dependent(region: Region, job: Job) -> None:
    if job.independent:
        raise OptionError(
            f"--region {region.mask}@{region.frame}: with --independent no triangle outlives its "
            "frame; give masks for all frames, without @"
        )


def _members(
    region: Region, job: Job, track: TrackReader, rows: Sequence[FrameRow]
) -> dict[int, np.ndarray]:
    """The triangles of a region in the frames of its shot, by frame."""
    _check_dependent(region, job)
    frames = [row.frame for row in track.rows]
    own = region.drawn_for
    if own not in frames:
        raise OptionError(
            f"--region {region.mask}@{own}: {track.path} has no frame {own}, it has frames "
            f"{frames[0]} to {frames[-1]}; draw the mask for one of them"
        )
    start = frames.index(own)
    shot = track.rows[start].shot
    wanted = [frames.index(row.frame) for row in rows if row.shot == shot]
    if not wanted:
        return {}
    found = _under(region, track)
    onward, back = frames[start : max(wanted) + 1], frames[min(wanted) : start + 1]
    return _carried(track, onward, found) | _carried(track, back[::-1], found)


def _under(region: Region, track: TrackReader) -> np.ndarray:
    """The triangles under the mask of a region, in its frame."""
    mesh = track.snapshot(region.drawn_for).mesh
    mask = Mask(region.mask, (mesh.width, mesh.height))
    try:
        return under_mask(mesh, mask.at(region.drawn_for))
    finally:
        mask.close()


def _carried(track: TrackReader, frames: list[int], members: np.ndarray) -> dict[int, np.ndarray]:
    """Carry members from the first of some neighbouring frames to the others."""
    carried = {}
    before = None
    for frame in frames:
        snapshot = track.snapshot(frame)
        if before is not None:
            members = inherited(before, snapshot, members[:, None])[:, 0]
        carried[frame] = members
        before = snapshot
    return carried
