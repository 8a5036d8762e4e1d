"""Motion beside that of the whole picture."""

import cv2
import numpy as np

from stages.flows.dis import Dis
from stages.flows.view import View
from stages.frame import Frame

LINES = 96
"""Short side of the copies that motion is looked for in [px]."""
BLUR = 2.0
"""Standard deviation of the blur of the map [px of those copies]."""
STILL = 0.0008
"""Motion beside that of the whole up to this is noise [short sides a frame]."""


def own_motion(before: Frame | None, frame: Frame, full: float) -> np.ndarray:
    """How much the places of a picture move against the whole.

    Args:
        before: The frame before in the shot; None for no motion.
        frame: The picture.
        full: Motion that counts as 1 [short sides a frame].

    Returns:
        [h, w] float32, 0 to 1.
    """
    if before is None or np.array_equal(before.pixels, frame.pixels):
        return np.zeros((1, 1), dtype=np.float32)
    flow = Dis(lines=LINES, preset="medium").estimate(View(before.pixels), View(frame.pixels))
    own = flow.vectors - dominant(flow.vectors)
    speeds = np.hypot(own[..., 0], own[..., 1]) / min(frame.width, frame.height)
    share = np.clip((speeds - STILL) / max(full - STILL, 1e-9), 0.0, 1.0)
    return cv2.GaussianBlur(share.astype(np.float32), (0, 0), BLUR)


def dominant(vectors: np.ndarray) -> np.ndarray:
    """The motion of the whole: an affine one that most places follow.

    Args:
        vectors: Motion, [h, w, 2].

    Returns:
        The dominant motion at the same places, [h, w, 2].
    """
    height, width = vectors.shape[:2]
    y, x = np.mgrid[-1.0 : 1.0 : height * 1j, -1.0 : 1.0 : width * 1j].reshape(2, -1)
    terms = np.stack([np.ones_like(x), x, y], axis=1)
    wanted = vectors.reshape(-1, 2).astype(np.float64)
    left = np.full(len(x), True)
    fitted = np.median(wanted, axis=0) + np.zeros_like(wanted)
    for _ in range(3):  # from the median on, places that go with it decide alone
        misfit = np.hypot(*(wanted - fitted).T)
        left = misfit <= max(1.5 * float(np.median(misfit)), 1e-3)
        fit, *_ = np.linalg.lstsq(terms[left], wanted[left], rcond=None)
        fitted = terms @ fit
    return fitted.reshape(vectors.shape)
