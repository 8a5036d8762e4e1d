"""What lingers of the frames before: triangles fade in over those that they replaced.

A triangle is new where no triangle of the frame before had the same three vertices: after a
split, a flip or a collapse. The new ones of a frame cover what the vanished ones covered, so
through a new one those are seen that lay where its material was one frame earlier, in the colours
that they had then; and through these, if they were new themselves, those before them. Every point
of a triangle that persists keeps its own colour, to the bit.
"""

from dataclasses import dataclass, replace

import numpy as np

from stages.look.paint import paint_of
from stages.mesh import Mesh
from stages.motion.backtrack import earlier_vertices
from stages.motion.correspondence import by_vertex_id, kept_triangles
from stages.motion.overlaps import overlaps
from stages.snapshot import Snapshot
from warp_kernels.drawing.layers import Layers
from warp_kernels.drawing.paint import Paint, joined_paint
from warp_kernels.scene.stroke_lay import Lay

MATURE = -(1 << 40)
"""Birth of what was there from the beginning, or replaces nothing: it never fades."""
STRETCH = 0.25
"""A triangle that has been stretched, turned or sheared by this part since its birth is opaque at
once: there the picture itself changes, and what was there before would trail behind it."""


@dataclass(frozen=True, eq=False)
class Origins:
    """Where triangles came from."""

    births: np.ndarray
    """Number of the step with which each came, or `MATURE`; [N] int64."""
    corners: np.ndarray
    """Where its corners, ascending by vertex id, lay one frame before that [px], [N, 3, 2]."""
    spans: np.ndarray
    """Begin and end of what it replaced, in the links of that step; [N, 2] int64."""

    def of(self, triangles: np.ndarray) -> "Origins":
        """The origins of some of the triangles, by their numbers [M]."""
        return Origins(self.births[triangles], self.corners[triangles], self.spans[triangles])


@dataclass(frozen=True, eq=False)
class Vanished:
    """The triangles that went with one step, as they were in the frame before."""

    paint: Paint
    """Their shapes and colours."""
    origins: Origins
    """Where they came from themselves."""
    maps: np.ndarray
    """The way there, for those that were fading: linear part and translation [px]; [G, 2, 3]."""
    links: np.ndarray
    """For one new triangle of the step after the other, which of these it lies over; [L]."""


@dataclass(frozen=True, eq=False)
class Fading:
    """A frame's triangles and what still shows through them."""

    frames: int
    """Most frames over which a triangle fades in; in the one after these it is opaque."""
    step: int
    """Number of the frame, counted in those that are drawn, from the first of the shot."""
    mesh: Mesh
    """Its triangles."""
    paint: Paint
    """Their shapes and colours."""
    origins: Origins
    """Where they came from."""
    vanished: dict[int, Vanished]
    """What went in the last steps, by step."""

    @classmethod
    def begin(
        cls,
        snapshot: Snapshot,
        frames: int,
        shares: np.ndarray | None = None,
        lay: Lay | None = None,
    ) -> "Fading":
        """The first frame of a shot, with nothing behind it.

        Args:
            snapshot: The frame.
            frames: Frames over which triangles fade in; 0 for none.
            shares: Which followed regions its triangles belong to, see `Paint`.
            lay: How strokes lie on them, the same.
        """
        count = snapshot.mesh.triangle_count
        origins = Origins(
            np.full(count, MATURE), np.zeros((count, 3, 2)), np.zeros((count, 2), np.int64)
        )
        return cls(frames, 0, snapshot.mesh, paint_of(snapshot, shares, lay), origins, {})

    def followed_by(
        self, snapshot: Snapshot, shares: np.ndarray | None = None, lay: Lay | None = None
    ) -> "Fading":
        """The next frame of the shot.

        Args:
            snapshot: The frame.
            shares: Which followed regions its triangles belong to, see `Paint`.
            lay: How strokes lie on them, the same.

        Returns:
            The same for every earlier frame with which it began, if more than `frames` ago.
        """
        mesh, step = snapshot.mesh, self.step + 1
        kept = kept_triangles(self.mesh, mesh)
        origins = self.origins.of(kept)
        vanished = {s: batch for s, batch in self.vanished.items() if step - s < self.frames}
        born = np.flatnonzero(kept < 0)
        stays = np.zeros(self.mesh.triangle_count + 1, dtype=bool)
        stays[kept] = True  # the last place is that of -1
        gone = np.flatnonzero(~stays[:-1])
        if self.frames and len(born) and len(gone):
            corners = self.mesh.vertices[by_vertex_id(self.mesh, gone)]
            before = earlier_vertices(self.mesh, mesh)[by_vertex_id(mesh, born)]
            spans, links = overlaps(before, corners)
            covers = spans[:, 1] > spans[:, 0]
            origins.births[born] = np.where(covers, step, MATURE)
            origins.corners[born], origins.spans[born] = before, spans
            vanished[step] = self._vanished(gone, corners, links)
        return replace(
            self,
            step=step,
            mesh=mesh,
            paint=paint_of(snapshot, shares, lay),
            origins=origins,
            vanished=vanished,
        )

    def _vanished(self, gone: np.ndarray, corners: np.ndarray, links: np.ndarray) -> Vanished:
        """What is kept of the triangles that go with the next step."""
        origins = self.origins.of(gone)
        fading = np.flatnonzero(self._is_young(origins))
        maps = np.zeros((len(gone), 2, 3))
        maps[fading] = _maps(corners[fading], origins.corners[fading])
        paint = self.paint.of(gone)
        return Vanished(paint, origins, maps, links)

    def layers(self) -> tuple[Paint, Layers | None]:
        """What is drawn: all layers, and how they lie over each other.

        Returns:
            The triangles alone and None if none of them fades.
        """
        young = np.flatnonzero(self._is_young(self.origins))
        if len(young) == 0:
            return self.paint, None
        batches = [self.vanished[step] for step in sorted(self.vanished)]
        sizes = [self.mesh.triangle_count, *(len(batch.paint.colors) for batch in batches)]
        begins = np.cumsum(sizes) - sizes
        links, link_begins = self._links(batches, begins[1:])
        paint = joined_paint([self.paint, *(batch.paint for batch in batches)])
        table = Layers(
            weights=np.ones(sum(sizes), np.float32),
            turns=np.zeros((sum(sizes), 2, 2), np.float32),
            departures=np.zeros((sum(sizes), 2)),
            spans=np.zeros((sum(sizes), 2), np.int32),
            links=links,
        )
        own, origins = self.mesh.vertices[by_vertex_id(self.mesh, young)], self.origins.of(young)
        parts = [(young, origins, _maps(own, origins.corners))]
        for begin, batch in zip(begins[1:], batches, strict=True):
            fading = np.flatnonzero(self._is_young(batch.origins))
            parts.append((begin + fading, batch.origins.of(fading), batch.maps[fading]))
        for layers, origins, maps in parts:
            ages = self.step - origins.births
            share = (ages + 1) / (self.frames + 1) + _stretch(maps) / STRETCH
            table.weights[layers] = _opacity(share)
            anchors = paint.corners[layers, 0]
            table.turns[layers] = maps[:, :, :2]
            table.departures[layers] = _mapped(maps, anchors)
            table.spans[layers] = origins.spans + link_begins[ages][:, None]
        return paint, table

    def _is_young(self, origins: Origins) -> np.ndarray:
        """Which triangles are not opaque yet, [N] bool."""
        return self.step - origins.births < self.frames

    def _links(self, batches: list[Vanished], begins: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """All links as numbers of layers [L], and where those of a step begin, by its age [N]."""
        ages = self.step - np.array(sorted(self.vanished))
        counts = np.array([len(batch.links) for batch in batches])
        link_begins = np.zeros(self.frames, np.int64)
        link_begins[ages] = np.cumsum(counts) - counts
        links = [batch.links + begin for batch, begin in zip(batches, begins, strict=True)]
        return np.concatenate(links).astype(np.int32), link_begins


def _opacity(share: np.ndarray) -> np.ndarray:
    """A smooth rise from 0 to 1: no speed at either end, so neither is seen as a change."""
    share = np.minimum(share, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _stretch(maps: np.ndarray) -> np.ndarray:
    """How far maps [N, 2, 3] are from a translation: the Frobenius norm of what differs [N]."""
    return np.linalg.norm(maps[:, :, :2] - np.eye(2), axis=(1, 2))


def _mapped(maps: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Where maps [N, 2, 3] take points [N, 2] [px]."""
    return (maps[:, :, :2] @ points[:, :, None])[:, :, 0] + maps[:, :, 2]


def _maps(corners: np.ndarray, earlier: np.ndarray) -> np.ndarray:
    """The affine maps that take triangles to where they were.

    Args:
        corners: Positions [px], [N, 3, 2]; of no triangle on a line.
        earlier: Their positions there [px], [N, 3, 2].

    Returns:
        Linear part and translation, [N, 2, 3].
    """
    sides = corners[:, 1:] - corners[:, :1]
    linear = np.linalg.solve(sides, earlier[:, 1:] - earlier[:, :1]).transpose(0, 2, 1)
    shift = earlier[:, 0] - (linear @ corners[:, 0, :, None])[:, :, 0]
    return np.concatenate([linear, shift[:, :, None]], axis=2)
