"""A face in a picture, and how much more the errors in and around it count."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

FACE_GAIN, FACE_RADIUS = 4.8, 0.55
"""What is added over a face, and how far it reaches from its middle [face sizes]."""
EYE_GAIN, EYE_RADII = 5.0, (0.12, 0.08)
"""The same over each eye; along the line through the eyes and across it [face sizes]."""
MOUTH_GAIN, MOUTH_RADII = 4.0, (0.16, 0.1)
"""The same over the mouth."""
DETAILED, RICHEST = 40.0, 2.0
"""A face that more mean triangles than this would cover counts the more, with the root of their
number, up to so many times: each of them brings less there, and of such a face there is more. Its
eyes and mouth, which have triangles enough, count as much less."""
REACH = 1.0
"""Beyond this distance from its middle a face adds nothing [face sizes]."""
LEAST_RADIUS = 1.5
"""Features of small faces reach at least as far as this [px]."""
FINEST = 128
"""Most pixels across of what is drawn for one face, before it is enlarged."""


@dataclass(frozen=True, eq=False)
class Face:
    """Where a face is seen."""

    places: np.ndarray
    """Middle of the face, its right eye (left in the picture), left eye and mouth [px], [4, 2]."""
    size: float
    """Side of the square from the brows to the chin [px]."""
    share: float = 1.0
    """How much of a face this is [0..1]: one that appears or goes counts in part."""

    @property
    def middle(self) -> np.ndarray:
        """Middle of the face [px], [2]."""
        middle: np.ndarray = self.places[0]
        return middle


def emphasis(faces: Sequence[Face], size: tuple[int, int], area: float = np.inf) -> np.ndarray:
    """What faces add to the weight 1 of every pixel.

    Over a face a plateau, which leads triangles to its outline and shades; over eyes and mouth a
    second one. Faces that overlap count once.

    Args:
        faces: The faces.
        size: Width and height of the picture [px].
        area: Of a triangle in the mean [px^2].

    Returns:
        [H, W] float32, 0 far from every face.
    """
    width, height = size
    added = np.zeros((height, width), dtype=np.float32)
    for face in faces:
        reach = int(np.ceil(REACH * face.size)) + 1
        left, top = np.floor(face.middle).astype(int) - reach
        richness = float(np.clip(face.size / np.sqrt(DETAILED * area), 1.0, RICHEST))
        patch = _emphasis_of(face, left, top, 2 * reach, richness)
        columns = slice(*np.clip((left, left + 2 * reach), 0, width))
        rows = slice(*np.clip((top, top + 2 * reach), 0, height))
        window = added[rows, columns]
        if window.size:
            seen = patch[rows.start - top : rows.stop - top, columns.start - left :]
            np.maximum(window, seen[:, : window.shape[1]], out=window)
    return added


def _emphasis_of(face: Face, left: int, top: int, side: int, richness: float) -> np.ndarray:
    """What one face adds in a square of the picture.

    Args:
        face: The face.
        left: Where the square begins [px].
        top: The same [px].
        side: Its side [px].
        richness: How many times more the face counts, and less its features.

    Returns:
        [side, side] float32.
    """
    count = min(side, FINEST)  # large faces are drawn small: there is nothing sharp in it
    steps = (np.arange(count, dtype=np.float32) + 0.5) * (side / count)
    y, x = np.meshgrid(top + steps, left + steps, indexing="ij")
    across = face.places[2] - face.places[1]
    across = across / max(float(np.hypot(*across)), 1e-6)

    def bump(place: np.ndarray, radii: tuple[float, float], power: int) -> np.ndarray:
        """1 at a place, falling off around it."""
        reach = np.maximum(np.array(radii) * face.size, LEAST_RADIUS)
        dx, dy = x - np.float32(place[0]), y - np.float32(place[1])
        along = (dx * across[0] + dy * across[1]) / reach[0]
        aside = (dy * across[0] - dx * across[1]) / reach[1]
        squares = along.astype(np.float32) ** 2 + aside.astype(np.float32) ** 2
        falling: np.ndarray = np.exp(-0.5 * squares ** (power // 2))
        return falling

    middle, *eyes, mouth = face.places
    features = np.maximum(*(EYE_GAIN * bump(eye, EYE_RADII, 2) for eye in eyes))
    features = np.maximum(features, MOUTH_GAIN * bump(mouth, MOUTH_RADII, 2))
    whole = FACE_GAIN * bump(middle, (FACE_RADIUS, FACE_RADIUS), 4)
    total = richness * whole + features / richness
    distance = np.hypot(x - np.float32(middle[0]), y - np.float32(middle[1])) / face.size
    edge = np.clip((REACH - distance) / (0.2 * REACH), 0.0, 1.0)  # nothing ends with a step
    result = (face.share * edge * total).astype(np.float32)
    return result if count == side else cv2.resize(result, (side, side))
