"""Edits by hand of any kind at random places, some of which cannot be made."""

from collections.abc import Callable
from typing import Any

import numpy as np

from stages.hand import EDITS, Edit

OUTSIDE = 10.0
"""So far beyond the picture an edit may be [px]."""
REACH = 60.0
"""Size of a region [px]."""


def random_edit(rng: np.random.Generator, size: tuple[int, int], frame: int = 0) -> Edit:
    """One edit.

    Args:
        rng: Source of the draws.
        size: Width and height of the picture [px].
        frame: Number of the frame.
    """
    name = list(EDITS)[rng.integers(len(EDITS))]
    at = _drawn(rng, (-OUTSIDE, -OUTSIDE), OUTSIDE + np.array(size))
    corners = [_drawn(rng, np.array(at) - REACH, np.array(at) + REACH) for _ in range(4)]
    few = {"count": int(rng.integers(1, 30)), "seed": int(rng.integers(99))}
    disc = {"at": at, "radius": float(rng.uniform(5, REACH))}
    region = disc if rng.random() < 0.5 else {"polygon": tuple(corners)}
    what = {"what": str(rng.choice(["vertices", "edges"]))}
    others: dict[str, Callable[[], dict[str, Any]]] = {
        "move_vertex": lambda: {"at": at, "to": (at[0] + 4.0, at[1] - 3.0)},
        "insert": lambda: disc | few,
        "remove": lambda: disc | few,
        "retriangulate": lambda: {"polygon": tuple(corners), **few},
        "lock": lambda: {"polygon": tuple(corners), **what},
        "unlock": lambda: {"polygon": tuple(corners), **what},
        "set_focus": lambda: region | {"strength": float(rng.choice([0.5, 1.0, 3.0]))},
        "style_region": lambda: region | {"style": "edges"},
        "texture_region": lambda: region | {"file": "cushion"},
    }
    values = others.get(name, lambda: {"at": at})()
    edit: Edit = EDITS[name](frame=frame, **values)  # type: ignore[call-arg]
    return edit


def _drawn(rng: np.random.Generator, low: Any, high: Any) -> tuple[float, float]:
    """A random point [px]."""
    x, y = rng.uniform(low, high)
    return float(x), float(y)
