"""Motion of the middle of a patch that turns and stretches on its way."""

import cv2
import numpy as np

from stages.flows.field import FlowField

HALF = 10
"""Patches reach this far from their middle [px]."""
FIRM = 1e5
"""How firmly patches keep their shape [code value^2 px^2]: noise must not turn them."""
ROUNDS = 6
"""Steps of Gauss and Newton; found by trial: more change nothing that can be seen."""
FURTHEST = 1.0
"""What leads further away is not believed [px]."""
AROUND, SAMPLES = 20.0, 7
"""How far around a point motion tells how its patch turns [px], and at how many places a side."""
WORTH = 0.3
"""A patch is believed to turn or stretch where that leaves at most this part of what it leaves as a
whole: a lesser gain is as likely noise, or what passes behind it."""
MOST = 256
"""Patches that are worked on at once: each needs 21 kB for its gradients."""
_SIDE = np.arange(-HALF, HALF + 1, dtype=np.float64)
_OFFSETS = np.stack(np.meshgrid(_SIDE, _SIDE), axis=-1).reshape(-1, 2)


def shapes(flow: FlowField, points: np.ndarray) -> np.ndarray:
    """How motion changes around points: what a patch there does besides going on.

    Args:
        flow: The motion.
        points: Positions [px], shape [N, 2].

    Returns:
        Change of the motion by the place, by least squares [1], shape [N, 2, 2].
    """
    side = np.linspace(-AROUND, AROUND, SAMPLES)
    offsets = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    motions = flow.at((points[:, None] + offsets).reshape(-1, 2)).reshape(len(points), -1, 2)
    changes: np.ndarray = np.einsum("nki,kj->nij", motions, offsets)
    return changes / (offsets[:, 0] ** 2).sum()


def settled(
    points: np.ndarray,
    steps: np.ndarray,
    turns: np.ndarray,
    earlier: np.ndarray,
    later: np.ndarray,
) -> np.ndarray:
    """Refine steps that patches were found to go as a whole.

    Where a patch turns or stretches, what is found of it as a whole is the motion of where its
    contrast lies, not that of its middle: in a chain from picture to picture such errors add up.

    Args:
        points: Positions in the earlier picture [px of the pictures], shape [N, 2].
        steps: Their steps, to a pixel [px of the pictures], shape [N, 2].
        turns: What they do besides, about, as `shapes` tells, [N, 2, 2].
        earlier: The earlier picture, grey, shape [h, w] uint8.
        later: The later picture, of the same shape.

    Returns:
        Steps [px of the pictures], shape [N, 2]; those given where others fit no better.

    Source: Shi & Tomasi, Good features to track (1994): affine motion of patches. Solved with the
        gradients of the earlier picture, which stay, as by Baker & Matthews (2004).
    Deviation: a spring holds the shape near to what the flow says of it.
    """
    slopes = [cv2.Scharr(earlier, cv2.CV_32F, *axis, scale=1 / 32) for axis in ((1, 0), (0, 1))]
    parts = [slice(begin, begin + MOST) for begin in range(0, len(points), MOST)]
    found = [_settled(points[p], steps[p], turns[p], (earlier, later), slopes) for p in parts]
    return np.concatenate(found) if found else steps


def _settled(
    points: np.ndarray,
    steps: np.ndarray,
    turns: np.ndarray,
    pictures: tuple[np.ndarray, np.ndarray],
    gradients: list[np.ndarray],
) -> np.ndarray:
    """See `settled`; all patches at once."""
    earlier, later = pictures
    places = points[:, None] + _OFFSETS
    patches = _values(earlier, places)
    across, down = _OFFSETS.T
    slopes = [_values(gradient, places) for gradient in gradients]
    slopes += [slope * offset for slope in slopes for offset in (across, down)]
    ways = np.stack(slopes, axis=-1)
    ways -= ways.mean(axis=1, keepdims=True)  # light that changes is no motion
    springs = np.array([1e-3, 1e-3, FIRM, FIRM, FIRM, FIRM])
    curvature = np.einsum("nki,nkj->nij", ways, ways) + np.diag(springs)
    inverse = np.linalg.inv(curvature)
    begun = np.concatenate([steps, turns.reshape(-1, 4)], axis=1)
    known = begun.copy()
    whole = _misfits(_differences(later, places + steps[:, None], patches))
    for _ in range(ROUNDS):
        differences = _differences(later, _laid(points, known), patches)
        pull = np.einsum("nki,nk->ni", ways, differences)
        pull[:, 2:] += FIRM * (known - begun)[:, 2:]
        known -= np.clip(np.einsum("nij,nj->ni", inverse, pull), -FURTHEST, FURTHEST)
    away = np.linalg.norm(known[:, :2] - begun[:, :2], axis=1)
    left = _misfits(_differences(later, _laid(points, known), patches))
    fits = (left < WORTH * whole) & (away <= FURTHEST)
    return np.where(fits[:, None], known[:, :2], steps)


def _laid(points: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Where the pixels of patches come to lie [px], [N, K, 2]."""
    turned = np.eye(2) + known[:, 2:].reshape(-1, 2, 2)
    moved: np.ndarray = np.einsum("kj,nij->nki", _OFFSETS, turned)
    return points[:, None] + known[:, None, :2] + moved


def _differences(later: np.ndarray, laid: np.ndarray, patches: np.ndarray) -> np.ndarray:
    """What a picture shows there beside patches, whatever the light [code values], [N, K]."""
    found = _values(later, laid) - patches
    return found - found.mean(axis=1, keepdims=True)


def _misfits(differences: np.ndarray) -> np.ndarray:
    """Sums of squares, [N]."""
    summed: np.ndarray = np.einsum("nk,nk->n", differences, differences)
    return summed


def _values(picture: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values of a picture between its pixels, continued beyond its border, [N, K] float64."""
    x, y = np.moveaxis((places - 0.5).astype(np.float32), -1, 0)
    found = cv2.remap(picture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return found.astype(np.float64)
