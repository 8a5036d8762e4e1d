"""Where a person painted that errors count more, followed from frame to frame by its triangles."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stages.frame import WHITE, Frame
from stages.masks.area import Stroke
from stages.masks.painted import painted, within_sides
from stages.mesh import Mesh
from stages.motion.inherit_regions import inherited, under_mask
from stages.snapshot import Snapshot

GAIN = 4.0
"""What a stroke of strength 1 adds to the weight 1 of a pixel, as what `--focus` names does."""
UNIT = 8
"""Weight of a pixel that counts once, as in what `--focus` names."""


@dataclass(frozen=True, eq=False)
class PaintedFocus:
    """What was painted, over the triangles of a frame."""

    snapshot: Snapshot | None = None
    """The frame; None if nothing was painted."""
    strengths: tuple[float, ...] = ()
    """Strengths of strokes, each once."""
    members: np.ndarray | None = None
    """Which triangles were painted with each, [T, R] bool."""

    def followed(self, after: Snapshot) -> "PaintedFocus":
        """The same over a neighbouring frame of the shot, the next one or the one before.

        Args:
            after: The frame.
        """
        if self.snapshot is None or self.members is None:
            return self
        members = inherited(self.snapshot, after, self.members)
        return replace(self, snapshot=after, members=members)

    def with_strokes(self, snapshot: Snapshot, strokes: Sequence[Stroke]) -> "PaintedFocus":
        """What was painted, and more.

        Args:
            snapshot: The frame that this is of, if anything was painted before.
            strokes: What is painted in it.
        """
        mesh = snapshot.mesh
        strengths = (*self.strengths, *(s.strength for s in strokes))
        strengths = tuple(dict.fromkeys(strengths))
        if not strengths:
            return self
        members = np.zeros((mesh.triangle_count, len(strengths)), dtype=bool)
        if self.members is not None:
            members[:, : len(self.strengths)] = self.members
        for place, strength in enumerate(strengths):
            areas = [stroke.area for stroke in strokes if stroke.strength == strength]
            members[:, place] |= under_mask(mesh, painted(areas, (mesh.width, mesh.height)))
        return PaintedFocus(snapshot, strengths, members)

    def weighed(self, frame: Frame, mesh: Mesh, strokes: Sequence[Stroke] = ()) -> Frame:
        """A frame whose errors count more where that was painted.

        Args:
            frame: The frame, with the weights that it has otherwise.
            mesh: A mesh that came from that of `snapshot`, as it lies in the frame.
            strokes: What was painted in the frame itself.
        """
        size = frame.width, frame.height
        added = np.zeros((frame.height, frame.width), dtype=np.float32)
        for place, strength in enumerate(self.strengths):
            assert self.snapshot is not None
            assert self.members is not None
            ids = self.snapshot.mesh.triangle_ids[self.members[:, place]]
            corners = mesh.corners[np.isin(mesh.triangle_ids, ids)]
            begins, ends = corners.reshape(-1, 2), np.roll(corners, -1, axis=1).reshape(-1, 2)
            inside = within_sides(begins, ends, size)
            added[inside] = np.maximum(added[inside], np.float32(strength))
        for stroke in strokes:
            inside = painted([stroke.area], size) > 0
            added[inside] = np.maximum(added[inside], np.float32(stroke.strength))
        if not added.any():
            return frame
        known = np.float32(UNIT) if frame.weights is None else frame.weights.astype(np.float32)
        total = known * (1.0 + np.float32(GAIN) * added)
        total *= min(np.float32(1.0), WHITE / total.max())
        return replace(frame, weights=np.maximum(np.rint(total), 1.0).astype(np.uint8))


NOTHING_PAINTED = PaintedFocus()
"""Errors count nowhere more than elsewhere."""
