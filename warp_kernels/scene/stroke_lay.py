"""How strokes lie on triangles: along their own base edges, or as they lay before."""

from dataclasses import dataclass

import numpy as np

from warp_kernels.scene.places import FRACTION, hashes_of, to_places

NEEDLE = np.float32(0.3)
"""Triangles with a side that is shorter than this part of the next one are needles."""
SHORTEST = np.float32(1e-6)
"""Sides are taken to be no shorter [px]."""


@dataclass(frozen=True, eq=False)
class Lay:
    """Where the strokes of some triangles lie, and where they lead."""

    owners: np.ndarray
    """Persistent number of the triangle that each pattern was drawn for, [N] int64."""
    directions: np.ndarray
    """Unit vectors along the strokes, [N, 2]."""
    places: np.ndarray
    """Where the centre of that triangle would be by now [px of the picture], [N, 2]."""

    def of(self, triangles: np.ndarray) -> "Lay":
        """That of some of the triangles, by their numbers [M]."""
        return Lay(self.owners[triangles], self.directions[triangles], self.places[triangles])

    def table(self, anchors: np.ndarray) -> np.ndarray:
        """What `Scene` has of it: directions, and places seen from corner 0 [px], [N, 4].

        Args:
            anchors: Places of the corners 0 [2^-16 px], [N, 2].
        """
        away = self.places - anchors / FRACTION
        return np.concatenate([self.directions, away], axis=1)


def joined_lay(parts: list[Lay]) -> Lay:
    """Those of several lots of triangles, one after the other."""
    return Lay(
        np.concatenate([part.owners for part in parts]),
        np.concatenate([part.directions for part in parts]),
        np.concatenate([part.places for part in parts]),
    )


def own_lay(ids: np.ndarray, corners: np.ndarray) -> Lay:
    """Strokes of triangles that have none yet: along the base edge, counted from the centre.

    What is farthest from the centre moves most when the base edge turns a little.

    Args:
        ids: Persistent numbers of the triangles, [N] int64.
        corners: Positions [px], [N, 3, 2].
    """
    places = to_places(corners)
    sides = ((places[:, 1:] - places[:, :1]) / FRACTION).astype(np.float32)
    centres = (sides[:, 0] + sides[:, 1]) / np.float32(3.0)
    return Lay(ids, _base_edges(sides, hashes_of(ids)), places[:, 0] / FRACTION + centres)


def _base_edges(sides: np.ndarray, hashes: np.ndarray) -> np.ndarray:
    """Unit vectors along the edges that strokes follow, chosen by chance but for ever, [N, 2].

    Args:
        sides: Corners 1 and 2 from corner 0 [px], [N, 2, 2] float32.
        hashes: Numbers without order that stay with the triangles, [N] uint32.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5: randomly chosen; Sec.
        3.5: users turn it, which turns the row of corners here.
    Deviation: never the short side of a needle, along which strokes would be a row of ticks that
        turn with every step of its ends; the next side is taken instead.
    """
    edges = np.stack([sides[:, 0], sides[:, 1] - sides[:, 0], -sides[:, 1]], axis=1)
    choices = ((hashes >> np.uint32(24)) % np.uint32(3)).astype(np.int64)
    numbers = np.arange(len(edges))
    chosen, following = edges[numbers, choices], edges[numbers, (choices + 1) % 3]
    lengths = [np.sqrt(e[:, 0] * e[:, 0] + e[:, 1] * e[:, 1]) for e in (chosen, following)]
    is_needle = lengths[0] < NEEDLE * lengths[1]
    edge = np.where(is_needle[:, None], following, chosen)
    length = np.where(is_needle, lengths[1], lengths[0])
    return edge / np.maximum(length, SHORTEST)[:, None]
