"""Maps of what counts, at the size of a picture."""

import cv2
import numpy as np


def enlarged(seen: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """A map at the size of a picture, between its values without steps.

    Args:
        seen: [h, w] float32 of any size.
        size: Width and height of the picture [px].

    Returns:
        [H, W] float32.
    """
    if seen.shape == (size[1], size[0]):
        return seen
    return cv2.resize(seen, size, interpolation=cv2.INTER_LINEAR)
