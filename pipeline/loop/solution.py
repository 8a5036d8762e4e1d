"""One frame after another: what a frame becomes, given what the one before it became."""

import numpy as np

from pipeline.envelope import MeshFrom, Prepared
from pipeline.options.solve_options import SolveOptions
from stages.motion.advect import advect
from stages.motion.painted_focus import NOTHING_PAINTED, PaintedFocus
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator


def followed(
    triangulator: Triangulator,
    options: SolveOptions,
    ready: Prepared,
    before: Snapshot | None,
    focus: PaintedFocus = NOTHING_PAINTED,
) -> Snapshot:
    """Triangulate a frame, from the mesh of the one before it where there is one.

    Args:
        triangulator: Has solved the frame before.
        options: Say how frames begin.
        ready: The frame.
        before: What the frame before became, or None if there is none.
        focus: What a person painted, as the frame before has it.
    """
    frame, mesh_from = ready.frame, ready.mesh_from
    triangulator.refine_by(options.course.refine(frame.index, options.triangulate.refine))
    if before is None or mesh_from is MeshFrom.LAYOUT:
        rng = np.random.default_rng([options.seed, frame.index])
        return triangulator.first(frame, options.layout, rng)
    if mesh_from is MeshFrom.TRACK:
        triangulator.recall(frame, before)
        return before
    if mesh_from is MeshFrom.SAME_PICTURE:
        return before.again(frame)
    seed = advect(before.mesh, mesh_from, before.locks)
    return triangulator.next(focus.weighed(frame, seed.mesh), seed, before)
