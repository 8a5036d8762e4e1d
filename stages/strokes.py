"""Where strokes lie, frame after frame: they move with what they are drawn on.

A triangle is a window through which strokes are seen. Its corners are moved by the optimiser as
well as by the picture, its base edge turns with every such move, and flips, splits and collapses
cut the windows anew; strokes that are tied to all this crawl. So they are carried by the motion of
the whole neighbourhood, and a new window goes on with the strokes that lay there before.
"""

from dataclasses import dataclass, replace

import numpy as np

from stages.correspond import kept_triangles
from stages.earlier import earlier_vertices
from stages.following import beneath
from stages.local_motion import Motions, local_motions, planar
from stages.mesh import Mesh, centres_of
from warp_kernels.lay import Lay, own_lay


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
        """The next frame of the shot.

        Args:
            mesh: Its triangles.
        """
        before = self.mesh
        sources = kept_triangles(before, mesh)
        if np.array_equal(before.vertices, mesh.vertices) and (
            np.array_equal(sources, np.arange(before.triangle_count))
        ):
            return replace(self, mesh=mesh)
        born = np.flatnonzero(sources < 0)
        if len(born):
            sources[born] = _most_beneath(before, mesh, born)
        motions = local_motions(mesh, mesh.vertices - earlier_vertices(before, mesh))
        return Strokes(mesh, self._carried(mesh, sources, motions))

    def _carried(self, mesh: Mesh, sources: np.ndarray, motions: Motions) -> Lay:
        """How strokes lie that go on; those that replace nothing are new.

        Args:
            mesh: The triangles now.
            sources: For each the triangle whose strokes it goes on with, or -1, [T].
            motions: How each has moved.
        """
        lay, known = self.lay.of(sources), sources >= 0
        centres = planar(centres_of(mesh.corners))
        # seen from where the centre was: an error of the turn moves what is far away most
        away = planar(lay.places) - (centres - motions.steps)
        moved = Lay(
            lay.owners,
            _pairs(planar(lay.directions) * motions.turns),
            _pairs(centres + motions.turns * away),
        )
        new = own_lay(mesh.triangle_ids, mesh.corners)
        return Lay(
            np.where(known, moved.owners, new.owners),
            np.where(known[:, None], moved.directions, new.directions),
            np.where(known[:, None], moved.places, new.places),
        )


def _most_beneath(before: Mesh, mesh: Mesh, born: np.ndarray) -> np.ndarray:
    """The triangles that lay beneath most of each new one, -1 where none did; [N].

    Args:
        before: The mesh of the frame before.
        mesh: The mesh.
        born: Numbers of its new triangles, [N].
    """
    owners, others, shares = beneath(before, mesh, born)
    found = np.full(len(born), -1)
    order = np.argsort(shares, kind="stable")
    found[owners[order]] = others[order]
    return found


def _pairs(numbers: np.ndarray) -> np.ndarray:
    """Complex numbers [N] as vectors, right and down [N, 2]."""
    return np.stack([numbers.real, numbers.imag], axis=1)
