"""All moves of a look, one after the other, at a frame."""

from collections.abc import Sequence

import numpy as np

from stages.look.paint import paint_of
from stages.moves import MOVES, Move
from stages.moves.pose import Pose, Resting
from stages.snapshot import Snapshot
from warp_kernels.drawing.moved import Moved
from warp_kernels.errors import OptionError


def moved_by(moves: Sequence[Move], snapshot: Snapshot, time: float) -> Moved | None:
    """Where the triangles of a frame are drawn.

    Args:
        moves: What moves them, the first one first.
        snapshot: The frame.
        time: When it is shown [s from the beginning of the film].

    Returns:
        None if every triangle is where it lies.
    """
    amounts = [(move, amount) for move in moves if (amount := move.amount_at(time)) != 0.0]
    if not amounts:
        return None
    mesh = snapshot.mesh
    resting = Resting(
        corners=mesh.corners,
        ids=mesh.triangle_ids,
        vertex_ids=mesh.vertex_ids[mesh.triangles],
        colors=paint_of(snapshot).colors,
        size=(mesh.width, mesh.height),
        time=time,
        frame=snapshot.frame_index,
    )
    pose = Pose.at_rest(resting)
    for move, amount in amounts:
        pose = move.moved(pose, resting, amount)
    return None if np.array_equal(pose.corners, resting.corners) and _is_plain(pose) else pose.drawn


def check_moment(moves: Sequence[Move]) -> None:
    """Refuse moves that run by themselves where there is one moment only.

    Args:
        moves: What moves the triangles of a still.

    Raises:
        OptionError: If one of them does.
    """
    for move in moves:
        if move.wants_time:
            name = MOVES.name_of(type(move))
            raise OptionError(
                f"--move {name}: runs by itself, and a still has one moment; say how far it has "
                f"gone, {name}:amount=0.5"
            )


def _is_plain(pose: Pose) -> bool:
    """Whether triangles are all there, and in the light of rest."""
    return bool((pose.presence == 1.0).all() and (pose.light == 1.0).all())
