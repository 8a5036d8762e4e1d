"""Parts of one shot that were solved apart: where they overlap one fades into the other.

The part that comes holds the frames of the overlap. Those of the part that goes stand behind the
end of the track, under numbers that no frame has, as what leads over the seam of a loop does;
their vertices bear the numbers of those that are the same in the part that comes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.options.seam import Seam
from pipeline.track.header import Header
from pipeline.track.plain_values import to_plain
from pipeline.track.reader import TrackReader
from pipeline.track.writer import TrackWriter
from stages.media import FrameRange
from stages.motion.matching import Matching


@dataclass(frozen=True)
class Joint:
    """Where one part fades into the next one."""

    first: int
    """The first frame of the next part that is shown."""
    going: Path
    """The track that goes."""
    over: int
    """Frames over which it goes."""


def finished_joints(track: Path, header: Header, joints: Sequence[Joint]) -> Header:
    """Write behind the end of a joined track what fades out.

    Args:
        track: It, which holds all frames that are shown.
        header: Its header.
        joints: Where parts overlap, in order.

    Returns:
        The header that the track has then.
    """
    if not joints:
        return header
    with TrackReader(track) as reader:
        rows = reader.rows
        last = reader.snapshot(rows[-1].frame)
        middles = [reader.snapshot(joint.first + joint.over // 2).mesh for joint in joints]
    seam = Seam(
        over=joints[0].over,
        opens=rows[0].frame,
        closes=rows[-1].frame,
        joints=tuple(joint.first for joint in joints),
    )
    header = _with_seam(header, seam)
    number, pts = seam.closes, last.pts
    step = rows[-1].pts - rows[-2].pts
    with TrackWriter.resume(track, header, last, rows[-1].shot) as writer:
        for joint, middle in zip(joints, middles, strict=True):
            shot = number + 1
            with TrackReader(joint.going) as going:
                mesh = going.snapshot(joint.first + joint.over // 2).mesh
                matching = Matching.between(mesh, middle)
                for frame in range(joint.first, joint.first + joint.over):
                    number, pts = number + 1, pts + step
                    snapshot = going.snapshot(frame)
                    mesh = matching.renumbered(snapshot.mesh)
                    writer.write(replace(snapshot, frame_index=number, pts=pts, mesh=mesh), shot)
        writer.finish()
    return header


def _with_seam(header: Header, seam: Seam) -> Header:
    """A header that says where parts meet."""
    first, last = seam.solved
    options = {**header.options, "seam": to_plain(seam)}
    moved = replace(header, options=options)
    return moved.with_range(FrameRange(first, last))
