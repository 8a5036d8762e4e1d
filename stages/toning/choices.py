"""Which colour of a palette each triangle has: it keeps it while no other is clearly nearer.

A colour that lies between two of a palette would else flicker between them with the noise of the
film. What is kept hangs on the triangle's number, from the first frame of the shot on.
"""

from dataclasses import dataclass

import numpy as np

from stages.toning.palette import Palette


@dataclass(frozen=True, eq=False)
class Choices:
    """The colours that triangles have taken, by the triangles' numbers."""

    ids: np.ndarray
    """Numbers of triangles, ascending, [N] int64."""
    colors: np.ndarray
    """The palette's colour that each has taken, [N] int64."""
    seen: np.ndarray
    """In which frame each was seen last, counted from the first of the shot, [N] int64."""
    step: int = 0
    """The frame."""

    @classmethod
    def none(cls) -> "Choices":
        """Nothing is taken yet."""
        empty = np.zeros(0, dtype=np.int64)
        return cls(empty, empty, empty, -1)

    def followed_by(
        self, ids: np.ndarray, lab: np.ndarray, palette: Palette, lingering: int = 0
    ) -> "Choices":
        """What is taken in the next frame.

        Args:
            ids: Numbers of its triangles, [T].
            lab: Their colours, see `oklab_colors`, [T, 3].
            palette: What there is to take.
            lingering: Frames for which triangles that vanished are still drawn.
        """
        step = self.step + 1
        taken = self.held(ids, lab, palette)
        kept = ~np.isin(self.ids, ids) & (step - self.seen <= lingering)
        every = np.concatenate([ids, self.ids[kept]])
        order = np.argsort(every)
        colors = np.concatenate([taken, self.colors[kept]])
        seen = np.concatenate([np.full(len(ids), step), self.seen[kept]])
        return Choices(every[order], colors[order], seen[order], step)

    def held(self, ids: np.ndarray, lab: np.ndarray, palette: Palette) -> np.ndarray:
        """What triangles take: what they had, unless another is nearer by `palette.hold`.

        Args:
            ids: Their numbers, in any order, [M].
            lab: Their colours, [M, 3].
            palette: What there is to take.

        Returns:
            Numbers of colours, [M].
        """
        nearest = palette.nearest(lab)
        if not len(self.ids):
            return nearest
        places = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
        had = np.where(self.ids[places] == ids, self.colors[places], nearest)
        own = palette.lab
        gain = _away(lab, own[had]) - _away(lab, own[nearest])
        return np.where(gain > palette.hold, nearest, had)

    def taken(self, ids: np.ndarray, lab: np.ndarray, palette: Palette) -> np.ndarray:
        """What triangles have in this frame; of those that are not known the nearest.

        Args:
            ids: Their numbers, in any order, [M].
            lab: Their colours, [M, 3].
            palette: What there is to take.

        Returns:
            Numbers of colours, [M].
        """
        found = palette.nearest(lab)
        if not len(self.ids):
            return found
        places = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
        return np.where(self.ids[places] == ids, self.colors[places], found)


def _away(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """How far colours [N, 3] are from others, [N]."""
    return np.sqrt(((one - other) ** 2).sum(axis=1))
