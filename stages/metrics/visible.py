"""Which pixels of a frame can be seen in another one."""

import numpy as np

from stages.metrics.warp import targets, warped

RELATIVE, ABSOLUTE = 0.01, 0.5
"""Motion there and back may miss its start by this part of its squared length, and by so much
[px^2]."""
BEND, LEAST_BEND = 0.01, 0.002
"""At a motion boundary the squared gradient exceeds this part of the squared length, and so much
[px^2]."""


def visible(forward: np.ndarray, backward: np.ndarray) -> np.ndarray:
    """Pixels whose motion is known: neither hidden in the other frame nor at a motion boundary.

    Args:
        forward: Motion from this frame to the other [px], shape [H, W, 2] float32.
        backward: Motion from the other frame to this one, of the same shape.

    Returns:
        Shape [H, W] bool.

    Source: Lai et al., Learning Blind Video Temporal Consistency (2018), after Ruder et al.,
        Artistic Style Transfer for Videos (2016).
    Deviation: pixels that leave the picture are hidden as well.
    """
    back = warped(backward, forward)
    lengths = _squares(forward)
    missed = _squares(back + forward) > RELATIVE * (_squares(back) + lengths) + ABSOLUTE
    bent = _gradient(forward) > BEND * lengths + LEAST_BEND
    columns, rows = targets(forward)
    height, width = forward.shape[:2]
    # Half a pixel beyond the outermost centres is still the picture.
    inside = (np.abs(columns + 0.5 - width / 2) <= width / 2) & (
        np.abs(rows + 0.5 - height / 2) <= height / 2
    )
    return inside & ~missed & ~bent


def _squares(vectors: np.ndarray) -> np.ndarray:
    """Squared lengths, [H, W]."""
    return vectors[..., 0] ** 2 + vectors[..., 1] ** 2


def _gradient(motion: np.ndarray) -> np.ndarray:
    """|grad u|^2 + |grad v|^2 by differences to the next pixel, 0 past the last; [H, W]."""
    total = np.zeros(motion.shape[:2], dtype=np.float32)
    total[:, :-1] += _squares(motion[:, 1:] - motion[:, :-1])
    total[:-1] += _squares(motion[1:] - motion[:-1])
    return total
