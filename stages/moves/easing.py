"""How something sets out and arrives, as shares of a way from 0 to 1."""

import numpy as np

Shares = np.ndarray
"""Numbers from 0 to 1."""


def smooth(share: Shares) -> Shares:
    """3 s^2 - 2 s^3: without speed at both ends."""
    s = np.clip(share, 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


def arriving(share: Shares) -> Shares:
    """Fast at first, and softly home."""
    return np.asarray(1.0 - (1.0 - np.clip(share, 0.0, 1.0)) ** 3)


def springing(share: Shares) -> Shares:
    """A little beyond the end, and back.

    Source: Robert Penner, Programming Macromedia Flash MX (2002), chapter 7: back, going out.
    """
    s = np.clip(share, 0.0, 1.0) - 1.0
    return np.asarray(1.0 + 2.70158 * s**3 + 1.70158 * s**2)


def landing(share: Shares) -> Shares:
    """A fall that ends with two short leaps.

    Source: Robert Penner, Programming Macromedia Flash MX (2002), chapter 7: bounce, going out.
    """
    s = np.clip(share, 0.0, 1.0)
    begins, lows = np.array([0.0, 6.0, 9.0, 10.5]) / 11.0, np.array([0.0, 0.75, 0.9375, 0.984375])
    leap = np.searchsorted(np.array([4.0, 8.0, 10.0]) / 11.0, s, side="right")
    return np.asarray(7.5625 * (s - begins[leap]) ** 2 + lows[leap])


def one_by_one(whole: float, turns: Shares, alone: float) -> Shares:
    """How far each of many is on its way, [T], if each begins when its turn comes.

    Args:
        whole: How much of the whole time is over, 0 to 1.
        turns: When each begins, from 0 for the first to 1 for the last, [T].
        alone: How long each takes, as a part of the whole, above 0.
    """
    return np.clip((whole - (1.0 - alone) * turns) / alone, 0.0, 1.0)


def ranked(keys: np.ndarray, ids: np.ndarray) -> Shares:
    """Turns in the order of keys, evenly spread, [T]; of two alike the older is first.

    Args:
        keys: What decides, [T].
        ids: Persistent numbers, [T].
    """
    turns = np.empty(len(keys))
    turns[np.lexsort((ids, keys))] = np.arange(len(keys)) / max(len(keys) - 1, 1)
    return turns
