"""Two pictures of one frame become one: what is seen while one look gives way to another.

All in whole numbers: the same bits everywhere.
"""

import numpy as np

ONE = 1 << 15
"""The whole of a share, in whole numbers."""


def faded(one: np.ndarray, other: np.ndarray, share: float) -> np.ndarray:
    """A mixture of code values.

    Args:
        one: Code values, [H, W, 3 or 4] uint8, with straight alpha if there are four.
        other: The same, of the same shape.
        share: How much of the other, 0 to 1.
    """
    return through(one, other, np.full((1, 1), round(ONE * share), np.int32))


def wiped(one: np.ndarray, other: np.ndarray, share: float, direction: str) -> np.ndarray:
    """The other picture on one side of a border that runs over the first one.

    Args:
        one: As for `faded`.
        other: As for `faded`.
        share: How far the border is, 0 to 1.
        direction: Where it goes: `left`, `right`, `up` or `down`.
    """
    across = direction in ("left", "right")
    side = one.shape[1] if across else one.shape[0]
    # the pixel that the border runs through shows as much of both as lies on its two sides
    weights = np.clip(share * side - np.arange(side), 0.0, 1.0)
    if direction in ("left", "up"):
        weights = weights[::-1]
    whole = np.rint(ONE * weights).astype(np.int32)
    return through(one, other, whole[None] if across else whole[:, None])


def through(one: np.ndarray, other: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """One picture through a mask, the other around it.

    Args:
        one: As for `faded`.
        other: As for `faded`.
        weights: How much of the other, 0 to `ONE`, [H, W] int32, or 1 for H or W.
    """
    if one.shape[2] == 3:
        mixed = one * (ONE - weights[..., None]) + other * weights[..., None]
        return ((mixed + ONE // 2) >> 15).astype(np.uint8)
    parts = [
        picture[..., 3].astype(np.int64) * weight
        for picture, weight in ((one, ONE - weights), (other, weights))
    ]
    alpha = parts[0] + parts[1]
    whole = np.maximum(alpha, 1)[..., None]
    colors = one[..., :3] * parts[0][..., None] + other[..., :3] * parts[1][..., None]
    result = np.empty(one.shape, np.uint8)
    result[..., :3] = (colors + whole // 2) // whole
    result[..., 3] = (alpha + ONE // 2) >> 15
    return result


def apart(
    one: np.ndarray,
    other: np.ndarray,
    weights: tuple[np.ndarray, np.ndarray],
    ground: tuple[float, float, float],
) -> np.ndarray:
    """Both pictures through masks of their own, and the ground where neither is seen.

    Args:
        one: As for `faded`.
        other: As for `faded`.
        weights: How much of each, [H, W] int32; together `ONE` at most.
        ground: Code values; with alpha nothing is seen there.
    """
    behind = np.zeros((1, 1, one.shape[2]), np.uint8)
    behind[..., :3] = np.rint(ground).astype(np.uint8)
    if one.shape[2] == 4:
        behind[..., 3] = 0
    seen = np.minimum(weights[0] + weights[1], ONE)
    # what is seen of the one, as a part of what is seen at all
    shares = (weights[1].astype(np.int64) * ONE // np.maximum(seen, 1)).astype(np.int32)
    both = through(one, other, shares)
    return through(np.broadcast_to(behind, both.shape), both, seen)


def thinned(picture: np.ndarray, ground: tuple[float, float, float], opacity: float) -> np.ndarray:
    """A picture that is seen in part.

    Args:
        picture: As for `faded`; with alpha it becomes more transparent.
        ground: What is seen behind one without alpha [code values].
        opacity: How much of it is seen, 0 to 1.
    """
    if opacity >= 1.0:
        return picture
    if picture.shape[2] == 4:
        result = picture.copy()
        result[..., 3] = np.rint(opacity * picture[..., 3]).astype(np.uint8)
        return result
    behind = np.empty_like(picture)
    behind[:] = np.rint(ground).astype(np.uint8)
    return faded(behind, picture, opacity)


def with_alpha(picture: np.ndarray) -> np.ndarray:
    """A picture with alpha: [H, W, 4] uint8; opaque if it had none."""
    if picture.shape[2] == 4:
        return picture
    return np.concatenate([picture, np.full_like(picture[..., :1], 255)], axis=2)
