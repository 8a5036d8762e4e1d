"""How thoroughly faces are searched for in a picture."""

import numpy as np

from stages.focus.face import Face
from stages.focus.yunet import YuNet, is_same

STILL, OPENING, PASSING = 1.5e6, 2.4e5, 5.4e4
"""Largest picture that the network gets of a still, of the first frame of a shot (and now and then
of later ones), and of the frames between [px]. It sees faces of 10 px and more there."""
STEP = 3.0
"""Each search is in a copy so many times smaller than the one before."""
COARSEST = 160
"""Until a copy is as small as this [px]; then a face that fills the picture is found."""
SURE = 0.77
"""From this on it is a face (see `YuNet.examined`)."""
LIKELY = 0.7
"""From this on it is one where two searches in a row see it: what only looks like a face once, as
a drawn animal does, has moved by then."""
MAYBE = 0.5
"""From this on it is one where one was before."""


class FaceSearch:
    """Searches for faces; not to be shared by threads.

    Raises:
        OptionError: If the network's file is missing.
    """

    def __init__(self) -> None:
        self._network = YuNet()

    def everywhere(self, pixels: np.ndarray, most: float) -> list[tuple[float, Face]]:
        """Search a whole picture.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            most: Size of the largest copy that is searched [px]: one of the three above.

        Returns:
            How sure it is, from `MAYBE` on, and the faces, the surest first.
        """
        height, width = pixels.shape[:2]
        scale = min(1.0, float(np.sqrt(most / (width * height))))
        scales = [scale]
        while most != PASSING and max(width, height) * scales[-1] > COARSEST:
            scales.append(scales[-1] / STEP)
        likely = [entry for scale in scales for entry in self._network.find(pixels, scale)]
        likely.sort(key=lambda entry: -entry[0])
        found: list[tuple[float, Face]] = []
        for _, face in likely:
            if any(is_same(face, other) for _, other in found):
                continue
            certainty, seen = self._network.examined(pixels, face)
            if certainty >= MAYBE and not any(is_same(seen, other) for _, other in found):
                found.append((certainty, seen))
        return sorted(found, key=lambda entry: -entry[0])

    def near(self, pixels: np.ndarray, face: Face) -> Face | None:
        """Look for a face around the place where it was before.

        Args:
            pixels: The picture, [H, W, 3] uint8.
            face: The face in an earlier picture.

        Returns:
            The face as it is now, or None.
        """
        certainty, seen = self._network.near(pixels, face)
        return seen if certainty >= MAYBE else None
