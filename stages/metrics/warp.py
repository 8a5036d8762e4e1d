"""Bring a picture to another frame along the motion."""

import cv2
import numpy as np

from stages.flows.field import FlowField


def dense(flow: FlowField) -> np.ndarray:
    """The vectors of a flow at every pixel's centre.

    Args:
        flow: Motion on a grid of any resolution.

    Returns:
        Motion [px], shape [height, width, 2] float32.
    """
    size = (flow.width, flow.height)
    return cv2.resize(flow.vectors, size, interpolation=cv2.INTER_LINEAR).reshape(*size[::-1], 2)


def targets(motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the pixels of a frame are in the other one.

    Args:
        motion: Motion at every pixel [px], shape [H, W, 2].

    Returns:
        Columns and rows, counted from the first pixel's centre [px], each [H, W] float32.
    """
    height, width = motion.shape[:2]
    columns = motion[..., 0] + np.arange(width, dtype=np.float32)
    rows = motion[..., 1] + np.arange(height, dtype=np.float32)[:, None]
    return columns, rows


def warped(picture: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """What each pixel of a frame finds in the other one, bilinear.

    Args:
        picture: The other frame, shape [H, W, C] float32.
        motion: Motion from this frame to the other at every pixel [px], shape [H, W, 2].

    Returns:
        Shape [H, W, C] float32; beyond the picture its border goes on.
    """
    columns, rows = targets(motion)
    found = cv2.remap(picture, columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return found.reshape(picture.shape)
