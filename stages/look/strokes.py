"""Where strokes lie, frame after frame: they move with what they are drawn on.

A triangle is a window through which its strokes are seen. The optimiser moves its corners, with
each of them its centre and its base edge, and flips and splits cut it anew; strokes that are tied
to all this crawl. So they lie on the picture instead: what carries them on is the motion of
the neighbourhood, and what becomes of the window does not matter to them.
"""

from dataclasses import dataclass, replace

import numpy as np

from stages.mesh import Mesh, centres_of
from stages.motion.correspondence import kept_rows, kept_vertices
from stages.motion.local_motion import Motions, local_motions, planar
from warp_kernels.scene.stroke_lay import Lay, own_lay

SHARERS = 2
"""So many triangles may show the same strokes: a part that was split off goes on with those of the
whole, but were that all, in the end a few kinds of strokes would cover the picture."""

THIN = 0.2
"""Triangles lower than this part of their longest side are too thin for strokes across them."""
ACROSS = 0.5
"""Cosine of the angle with the longest side from which on strokes run across it."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The strokes of one frame of a shot."""

    mesh: Mesh
    """Its triangles."""
    lay: Lay
    """How strokes lie on each."""

    @classmethod
    def begin(cls, mesh: Mesh) -> "Strokes":
        """The first frame of a shot: every triangle has strokes of its own.

        Args:
            mesh: Its triangles.
        """
        return cls(mesh, own_lay(mesh.triangle_ids, mesh.corners))

    def followed_by(self, mesh: Mesh) -> "Strokes":
        """The next frame of the shot: a triangle keeps its strokes as long as it has its id.

        Args:
            mesh: Its triangles.
        """
        before = self.mesh
        if _is_same(before, mesh):
            return replace(self, mesh=mesh)
        vertices = kept_vertices(before, mesh)
        is_known = vertices >= 0
        steps = np.where(is_known[:, None], mesh.vertices - before.vertices[vertices], 0.0)
        # those on the border stay there whatever the picture does
        tells = is_known & ~(mesh.on_left_right | mesh.on_top_bottom)
        motions = local_motions(mesh, steps, tells)
        centres = planar(centres_of(mesh.corners))
        sources = kept_rows(before.triangle_ids, mesh.triangle_ids)
        born = np.flatnonzero(sources < 0)
        if len(born):
            departures = (centres - motions.steps)[born]
            wholes = _split_from(before, mesh, sources, born, departures)
            sources[born] = self._shared(sources, wholes)
        return Strokes(mesh, self._carried(mesh, sources, motions, centres))

    def _shared(self, sources: np.ndarray, wanted: np.ndarray) -> np.ndarray:
        """Which of the triangles with whose strokes new ones want to go on these may have, or -1.

        Args:
            sources: For every triangle the one in the frame before that has its id, or -1, [T].
            wanted: For every new one the one that it wants, or -1, [N].
        """
        owners = self.lay.owners
        kinds, numbers = np.unique(owners, return_inverse=True)
        kept = np.bincount(numbers[sources[sources >= 0]], minlength=len(kinds))
        asked = np.where(wanted >= 0, numbers[wanted], len(kinds))
        order = np.argsort(asked, kind="stable")
        ranks = np.empty(len(asked), np.int64)
        ranks[order] = np.arange(len(asked)) - np.searchsorted(asked[order], asked[order])
        shared = ranks + np.append(kept, SHARERS)[asked]
        return np.where(shared < SHARERS, wanted, -1)

    def _carried(
        self, mesh: Mesh, sources: np.ndarray, motions: Motions, centres: np.ndarray
    ) -> Lay:
        """How strokes lie that go on; triangles that go on with none have new ones.

        Args:
            mesh: The triangles.
            sources: For each the one in the frame before with whose strokes it goes on, or -1, [T].
            motions: How each has moved.
            centres: Their centroids [px], [T] complex.
        """
        lay = self.lay.of(sources)
        away = planar(lay.places) - (centres - motions.steps)
        directions = _pairs(planar(lay.directions) * motions.turns)
        places = _pairs(centres + motions.turns * away)
        new = np.flatnonzero((sources < 0) | _run_across(mesh.corners, directions))
        own = own_lay(mesh.triangle_ids[new], mesh.corners[new])
        owners = lay.owners
        owners[new], directions[new], places[new] = own.owners, own.directions, own.places
        return Lay(owners, directions, places)


def _is_same(before: Mesh, mesh: Mesh) -> bool:
    """Whether a picture came again, and its mesh with it."""
    return all(
        np.array_equal(getattr(before, name), getattr(mesh, name))
        for name in ("vertices", "triangles", "triangle_ids")
    )


def _split_from(
    before: Mesh, mesh: Mesh, sources: np.ndarray, born: np.ndarray, departures: np.ndarray
) -> np.ndarray:
    """Of which neighbours new triangles were a part, as numbers in the frame before; -1 for none.

    Args:
        before: The mesh of that frame.
        mesh: The mesh.
        sources: For every triangle the one before that has its id, or -1, [T].
        born: Numbers of the new ones, [N].
        departures: Where their centres were [px], [N] complex.
    """
    twins = mesh.twins.reshape(-1, 3)[born]
    beside = np.where(twins >= 0, sources[twins // 3], -1)
    corners = planar(before.vertices[before.triangles[beside]])
    sides, away = np.roll(corners, -1, axis=2) - corners, departures[:, None, None] - corners
    is_inside = ((sides.conj() * away).imag >= 0.0).all(axis=2) & (beside >= 0)
    found = beside[np.arange(len(born)), is_inside.argmax(axis=1)]
    return np.where(is_inside.any(axis=1), found, -1)


def _run_across(corners: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Where strokes have become the rungs of a ladder, as a triangle became thin; [T] bool.

    Args:
        corners: Positions [px], [T, 3, 2].
        directions: Unit vectors along the strokes, [T, 2].
    """
    places = planar(corners)
    sides = np.roll(places, -1, axis=1) - places
    squares = sides.real**2 + sides.imag**2
    longest = np.arange(len(sides)), squares.argmax(axis=1)
    area = np.abs((sides[:, 0].conj() * sides[:, 1]).imag)
    along = np.abs((sides[longest].conj() * planar(directions)).real)
    square = squares[longest]
    return (area < THIN * square) & (along < ACROSS * np.sqrt(square))


def _pairs(numbers: np.ndarray) -> np.ndarray:
    """Complex numbers [N] as vectors, right and down [N, 2]."""
    return np.stack([numbers.real, numbers.imag], axis=1)
