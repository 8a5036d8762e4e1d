"""tOF: how differently an output and its source move."""

import cv2
import numpy as np


def motion_difference(
    source: tuple[np.ndarray, np.ndarray], output: tuple[np.ndarray, np.ndarray]
) -> float:
    """Mean distance between the ends of the motion vectors of a source and of its output.

    Args:
        source: An earlier and a later frame, code values, [H, W, 3] each.
        output: What became of them, of the same size.

    Returns:
        Mean over the pixels [px].

    Source: Chu et al., Learning Temporal Coherence via Self-Supervision for GAN-based Video
        Generation (TecoGAN, 2020), tOF, with its parameters of Farnebäck's flow.
    Deviation: distances are Euclidean, not sums of absolute values.
    """
    difference = _farneback(*source) - _farneback(*output)
    return float(np.mean(np.hypot(difference[..., 0], difference[..., 1]), dtype=np.float64))


def _farneback(earlier: np.ndarray, later: np.ndarray) -> np.ndarray:
    """Farnebäck's flow [px], shape [H, W, 2] float32."""
    grey = (cv2.cvtColor(_bytes(p), cv2.COLOR_RGB2GRAY) for p in (earlier, later))
    # OpenCV's annotations leave out that the initial flow is optional.
    return cv2.calcOpticalFlowFarneback(*grey, None, 0.5, 3, 15, 3, 5, 1.2, 0)  # type: ignore


def _bytes(picture: np.ndarray) -> np.ndarray:
    """Code values as bytes: the flow is made for these."""
    return picture if picture.dtype == np.uint8 else np.rint(picture).astype(np.uint8)
