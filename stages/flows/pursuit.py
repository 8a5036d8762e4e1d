"""Motion of a few points, each as closely as the picture around it tells."""

import cv2
import numpy as np

from stages.flows.deforming import settled

LINES = 720
"""Looked at in pictures whose short side is at most this long [px]."""
WINDOW = 21
"""Side of the square around a point that is compared [px of those pictures]."""
LEVELS = 2
"""Coarser levels that are looked at first; the estimate is close already."""
FURTHEST = 3.0
"""What leads further away from the estimate is not believed [px of those pictures]."""
RETURNS = 1.0
"""The way back must end this close to where the way began [px of those pictures]."""
_ENOUGH = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 30, 0.01)


def pursue(
    points: np.ndarray,
    steps: np.ndarray,
    turns: np.ndarray,
    earlier: np.ndarray,
    later: np.ndarray,
) -> np.ndarray:
    """Refine the steps of points; where the picture tells nothing they stay as they are.

    Every point is looked at alone, so the result depends on no thread and on no other point.

    Args:
        points: Positions in the earlier picture [px of the pictures], shape [N, 2].
        steps: Estimates of their steps [px of the pictures], shape [N, 2].
        turns: How motion changes around them [1], shape [N, 2, 2].
        earlier: The earlier picture, grey, shape [h, w] uint8.
        later: The later picture, of the same shape.

    Returns:
        Steps [px of the pictures], shape [N, 2].

    Source: Lucas & Kanade, An iterative image registration technique (1981), in pyramids as by
        Bouguet; the check of the way back is that of Kalal et al., Forward-backward error (2010).
    Deviation: what patches do that turn or stretch is looked at afterwards, see `settled`.
    """
    begin = (points - 0.5).astype(np.float32).reshape(-1, 1, 2)
    guess = (points + steps - 0.5).astype(np.float32).reshape(-1, 1, 2)
    end, found = _tracked(earlier, later, begin, guess)
    back, returned = _tracked(later, earlier, end, begin)
    near = np.linalg.norm((end - guess).reshape(-1, 2), axis=1) <= FURTHEST
    closed = np.linalg.norm((back - begin).reshape(-1, 2), axis=1) <= RETURNS
    told = found & returned & near & closed
    steps = steps.astype(np.float64)
    refined = (end - begin).reshape(-1, 2).astype(np.float64)[told]
    steps[told] = settled(points[told], refined, turns[told], earlier, later)
    return steps


def _tracked(
    earlier: np.ndarray, later: np.ndarray, points: np.ndarray, guess: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Where points went [N, 1, 2] float32, and whether that was found [N] bool."""
    end, found, _ = cv2.calcOpticalFlowPyrLK(
        earlier,
        later,
        points,
        guess.copy(),
        winSize=(WINDOW, WINDOW),
        maxLevel=LEVELS,
        criteria=_ENOUGH,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )
    return end, found.reshape(-1) == 1
