"""Where the triangles of a frame are on their way, and where they lie."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from stages.mesh import areas_of, centres_of
from warp_kernels.drawing.moved import Moved
from warp_kernels.scene.places import hashes_of

STRIDE = 0x1F3D5B79A7C5
"""What the ids of one triangle are apart for its different numbers without order."""
LUMA = (0.2126, 0.7152, 0.0722)
"""Shares of red, green and blue in brightness.

Source: ITU-R BT.709-6, item 3.2.
"""


@dataclass(frozen=True, eq=False)
class Resting:
    """A frame as moves look at it."""

    corners: np.ndarray
    """Positions of the corners of its triangles [px], [T, 3, 2]."""
    ids: np.ndarray
    """Persistent numbers of these, [T] int64."""
    vertex_ids: np.ndarray
    """Persistent numbers of the vertices at their corners, [T, 3] int64."""
    colors: np.ndarray
    """Their mean colours [code values], [T, 3]."""
    size: tuple[int, int]
    """Width and height of the picture [px]."""
    time: float
    """When it is shown [s from the beginning of the film]."""
    frame: int
    """Its number in the source."""

    @cached_property
    def centres(self) -> np.ndarray:
        """Centroids of the triangles [px], [T, 2]."""
        return centres_of(self.corners)

    @cached_property
    def areas(self) -> np.ndarray:
        """Their areas [px^2], [T]."""
        return np.abs(areas_of(self.corners))

    @cached_property
    def brightness(self) -> np.ndarray:
        """How bright they are, 0 to 255, [T]."""
        return np.asarray(self.colors @ np.array(LUMA))

    @property
    def shorter(self) -> float:
        """The shorter side of the picture [px]."""
        return float(min(self.size))

    @property
    def diagonal(self) -> float:
        """Its diagonal [px]."""
        return float(np.hypot(*self.size))

    def chance(self, number: int) -> np.ndarray:
        """A number from 0 to below 1 that stays with each triangle, [T].

        Args:
            number: Which of many.
        """
        return chances(self.ids, number)

    def point(self, x: float, y: float) -> np.ndarray:
        """A place of the picture [px], [2].

        Args:
            x: Share of its width.
            y: Share of its height.
        """
        return np.array([x * self.size[0], y * self.size[1]])


@dataclass(frozen=True, eq=False)
class Pose:
    """Where triangles are drawn, after some moves."""

    corners: np.ndarray
    """Positions of their corners [px of the picture], [T, 3, 2]."""
    presence: np.ndarray
    """How much of them there is, 0 to 1, [T]."""
    light: np.ndarray
    """How much brighter they are than at rest, as a factor, [T]."""
    depths: np.ndarray
    """How near they are: the larger number is seen, [T]."""

    @classmethod
    def at_rest(cls, resting: Resting) -> "Pose":
        """Every triangle where it lies."""
        count = len(resting.ids)
        return cls(resting.corners, np.ones(count), np.ones(count), np.zeros(count))

    @property
    def drawn(self) -> Moved:
        """The same for what draws it."""
        return Moved(self.corners, self.presence, self.light, self.depths)

    def carried(self, linear: np.ndarray, shift: np.ndarray) -> "Pose":
        """Every triangle turned about its centroid, then shifted.

        Args:
            linear: What becomes of vectors in it, [T, 2, 2].
            shift: Where it goes [px], [T, 2].
        """
        centres = centres_of(self.corners)[:, None]
        turned = np.einsum("tij,tcj->tci", linear, self.corners - centres)
        return replace(self, corners=centres + turned + shift[:, None])

    def shown(
        self,
        presence: np.ndarray | float = 1.0,
        light: np.ndarray | float = 1.0,
        nearer: np.ndarray | float = 0.0,
    ) -> "Pose":
        """The same in another light.

        Args:
            presence: How much is left of what there is, 0 to 1, [T].
            light: How much brighter it becomes, as a factor, [T].
            nearer: How much nearer it comes, [T].
        """
        return replace(
            self,
            presence=self.presence * presence,
            light=self.light * light,
            depths=self.depths + nearer,
        )


def chances(ids: np.ndarray, number: int) -> np.ndarray:
    """A number from 0 to below 1 for each id, the same on every machine.

    Args:
        ids: Persistent numbers, int64.
        number: Which of many; whatever it is, the numbers have no order.
    """
    mixed = ids.astype(np.uint64) + np.uint64(number % (1 << 20)) * np.uint64(STRIDE)
    return hashes_of(mixed.astype(np.int64)) / float(1 << 32)
