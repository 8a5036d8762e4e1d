"""Where edits say that errors count more, through a shot."""

from collections.abc import Iterable
from pathlib import Path

from pipeline.options.edit_log import EditLog
from pipeline.track import TrackReader
from stages.hand.regions.set_focus import SetFocus
from stages.hand.worked import Worked
from stages.masks.area import Stroke
from stages.mesh import Mesh
from stages.motion.painted_focus import NOTHING_PAINTED, PaintedFocus
from stages.snapshot import Snapshot


def painted_in(log: EditLog, frame: int, mesh: Mesh) -> tuple[Stroke, ...]:
    """What is painted in a frame itself.

    Args:
        log: The edits; those that cannot be made are left out.
        frame: Number of the frame.
        mesh: Its mesh, before or after its edits.
    """
    painting = EditLog(tuple(edit for edit in log.edits if isinstance(edit, SetFocus)))
    return painting.replay(frame, Worked(mesh)).worked.focus


def followed_focus(focus: PaintedFocus, log: EditLog, frames: Iterable[Snapshot]) -> PaintedFocus:
    """Follow what was painted through frames of a shot, with what is painted in these.

    Args:
        focus: What was painted up to the frame before them.
        log: The edits.
        frames: Frames that are final, in order.
    """
    for snapshot in frames:
        focus = focus.followed(snapshot)
        if strokes := painted_in(log, snapshot.frame_index, snapshot.mesh):
            focus = focus.with_strokes(snapshot, strokes)
    return focus


def focus_reached(log: EditLog | None, track: Path) -> PaintedFocus:
    """What was painted, as the last frame of a track has it.

    Args:
        log: The edits, or None.
        track: The track that a job goes on with.

    Raises:
        TrackError: If the track is damaged.
    """
    if log is None or not any(isinstance(e, SetFocus) for e in log.edits):
        return NOTHING_PAINTED
    with TrackReader(track) as reader:
        shot = reader.rows[-1].shot
        rows = [row for row in reader.rows if row.shot == shot]
        return followed_focus(NOTHING_PAINTED, log, (reader.snapshot(r.frame) for r in rows))
