"""Motion of single points: the pictures around them decide between the motions nearby.

Vertices stand on the outlines of things, which is where an estimate of motion is worst: it mixes
what is in front with what is behind. An outline belongs to what is in front, and so does most of
the contrast around it; so the motion that brings the patch around a point to where it looks the
same is that of the outline.
"""

import cv2
import numpy as np

from stages.flows.field import FlowField

LINES = 180
"""The patches are cut from pictures whose short side is at most this long [px]."""
REACH = 3.0
"""How far around a point other motions are looked at [px of those pictures]."""
DIRECTIONS = 8
"""How many of them."""
HALF_PATCH = 3
"""A patch reaches this far from its point [px of those pictures]."""
BIAS = 1.0
"""By how much the patch of another motion must fit better than that of the motion at the point
itself, or than standing still [code values]."""
MOST_ROWS = 30000
"""Points that OpenCV samples in one call: it takes pictures of less than 32768 rows."""


def vote(
    points: np.ndarray, flow: FlowField, earlier: np.ndarray, later: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Choose a motion for each point: of those around it the one that its patch confirms.

    Args:
        points: Positions in the earlier picture [px], shape [N, 2].
        flow: Motion from the earlier picture to the later one.
        earlier: The earlier picture, grey, at most `LINES` on its short side, shape [h, w] uint8.
        later: The later picture, of the same shape.

    Returns:
        Motion [px], shape [N, 2], and how badly the patch fits there: mean absolute difference
        [code values], shape [N].
    """
    scale = np.array([earlier.shape[1] / flow.width, earlier.shape[0] / flow.height])
    angles = np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS)
    around = REACH * np.stack([np.cos(angles), np.sin(angles)], axis=1) / scale
    places = points + np.concatenate([np.zeros((1, 2)), around])[:, None]
    motions = flow.at(places.reshape(-1, 2)).reshape(places.shape)
    motions = np.insert(motions, 1, 0.0, axis=0)
    misfits = _misfits(scale * points, scale * motions, earlier, later)
    handicap = np.full((len(motions), 1), BIAS, dtype=np.float32)
    handicap[:2] = 0.0  # the motion at the point itself, then standing still
    chosen = (misfits + handicap).argmin(axis=0), np.arange(len(points))
    return motions[chosen], misfits[chosen]


def unlikeness(
    points: np.ndarray, steps: np.ndarray, earlier: np.ndarray, later: np.ndarray
) -> np.ndarray:
    """How much the patch around each point looks unlike what is where it has gone.

    Args:
        points: Positions in the earlier picture [px of the pictures], shape [N, 2].
        steps: How far they went [px of the pictures], shape [N, 2].
        earlier: The earlier picture, shape [h, w] uint8.
        later: The later picture, of the same shape.

    Returns:
        Mean absolute difference of the two patches, and the root of their mean variance [code
        values], shape [N, 2].
    """
    centres = points - 0.5
    cut, laid = _patches(earlier, centres), _patches(later, centres + steps)
    misfits = cv2.absdiff(laid, cut).mean(axis=1, dtype=np.float64)
    variances = cut.var(axis=1, dtype=np.float64) + laid.var(axis=1, dtype=np.float64)
    return np.stack([misfits, np.sqrt(0.5 * variances)], axis=1)


def _misfits(
    points: np.ndarray, motions: np.ndarray, earlier: np.ndarray, later: np.ndarray
) -> np.ndarray:
    """How badly the patch around each point fits where each of its motions takes it.

    Args:
        points: Positions [px of the pictures], shape [N, 2].
        motions: Steps [px of the pictures], shape [K, N, 2].
        earlier: Where patches are cut, shape [h, w] uint8.
        later: Where they are laid, of the same shape.

    Returns:
        Mean absolute difference [code values], shape [K, N].
    """
    centres = points - 0.5
    cut = _patches(earlier, centres)
    laid = _patches(later, (centres + motions).reshape(-1, 2)).reshape(len(motions), *cut.shape)
    return cv2.absdiff(laid, np.broadcast_to(cut, laid.shape)).mean(axis=2, dtype=np.float32)


def _patches(picture: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Patches around places [N, 2], bilinear and continued beyond the border; [N, P] uint8."""
    side = np.arange(-HALF_PATCH, HALF_PATCH + 1, dtype=np.float32)
    x, y = centres.T.astype(np.float32)[:, :, None]
    x, y = x + np.tile(side, len(side)), y + np.repeat(side, len(side))
    parts = [
        cv2.remap(
            picture,
            x[begin : begin + MOST_ROWS],
            y[begin : begin + MOST_ROWS],
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REPLICATE,
        )
        for begin in range(0, len(centres), MOST_ROWS)
    ]
    return np.concatenate(parts)
