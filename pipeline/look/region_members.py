"""Regions that stay with their triangles, over the frames of a track."""

from collections.abc import Iterator, Sequence

import numpy as np

from pipeline.look.region_masks import check_dependent, own_mask
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.track import FrameRow, TrackReader
from stages.masks.region import Region
from stages.motion.inherit_regions import inherited, under_mask
from warp_kernels.errors import OptionError

MEMBER = 255
"""Share of a triangle that belongs to a region."""


def followed_shares(
    options: SolveOptions, look: Look, track: TrackReader, rows: Sequence[FrameRow]
) -> Iterator[np.ndarray | None]:
    """Which triangles the followed regions of a look hold.

    They are followed through all frames between the one that the mask was drawn for and the one
    that is asked for: a part of a track looks as it does in the whole.

    Args:
        options: Say how the frames were solved.
        look: Has the regions.
        track: The whole track.
        rows: Frames of it, in order.

    Yields:
        For every frame `Paint.shares` [T, R] uint8, or None if the look follows no region.

    Raises:
        OptionError: If the track has no such frame, or its frames have nothing in common.
        MediaError: If a mask cannot be read.
        TrackError: If the track is damaged.
    """
    regions = look.followed
    if not regions:
        yield from (None for _ in rows)
        return
    members = [_members(region, options, track, rows) for region in regions]
    for row in rows:
        columns = [of_frame.get(row.frame) for of_frame in members]
        blank = np.zeros(row.triangle_count, dtype=bool)
        shares = np.stack([blank if c is None else c for c in columns], axis=1)
        yield MEMBER * shares.astype(np.uint8)


def _members(
    region: Region, options: SolveOptions, track: TrackReader, rows: Sequence[FrameRow]
) -> dict[int, np.ndarray]:
    """The triangles of a region, by frame: what is carried there from the nearest of its own."""
    check_dependent(region, options)
    frames = [row.frame for row in track.rows]
    members: dict[int, np.ndarray] = {}
    for own, asked in _turns(region, track, rows).items():
        start, first, last = (frames.index(frame) for frame in (own, min(asked), max(asked)))
        onward, back = frames[start : last + 1], frames[first : start + 1]
        found = _under(region, track, own)
        carried = _carried(track, onward, found) | _carried(track, back[::-1], found)
        members |= {frame: carried[frame] for frame in asked}
    return members


def _turns(region: Region, track: TrackReader, rows: Sequence[FrameRow]) -> dict[int, list[int]]:
    """The frames for which each of a region's own is the nearest of the shot, the first of two."""
    shots = {row.frame: row.shot for row in track.rows}
    for frame in region.frames:
        if frame not in shots:
            raise OptionError(
                f"--region {region.mask}@{frame}: no frame {frame} was solved, only frames "
                f"{track.rows[0].frame} to {track.rows[-1].frame}; draw the mask for one of them"
            )
    turns: dict[int, list[int]] = {}
    for row in rows:
        own = [frame for frame in region.frames if shots[frame] == row.shot]
        if own:
            away = [abs(frame - row.frame) for frame in own]
            turns.setdefault(own[away.index(min(away))], []).append(row.frame)
    return turns


def _under(region: Region, track: TrackReader, frame: int) -> np.ndarray:
    """The triangles under the mask of a region, in one of its frames."""
    mesh = track.snapshot(frame).mesh
    return under_mask(mesh, own_mask(region, frame, (mesh.width, mesh.height)))


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
