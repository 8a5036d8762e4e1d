"""How a value goes from one key to the next: the names of CSS and those of Penner in one table.

Source: W3C, CSS Easing Functions Level 1; Penner, Programming Macromedia Flash MX (2002), Ch. 7,
    in the form of https://easings.net.
"""

import re
from collections.abc import Callable
from functools import partial
from math import cos, pi, sin, sqrt

Easing = Callable[[float], float]
"""From 0 to 1 for 0 to 1."""


def _cubic_bezier(x1: float, y1: float, x2: float, y2: float) -> Easing:
    """A curve of CSS; the parameter of a place is found by halving, to the last bit that counts."""

    def along(a: float, b: float, s: float) -> float:
        """One coordinate."""
        return 3 * (1 - s) ** 2 * s * a + 3 * (1 - s) * s * s * b + s**3

    def ease(x: float) -> float:
        """The height at a place."""
        low, high = 0.0, 1.0
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if along(x1, x2, middle) < x else (low, middle)
        return along(y1, y2, (low + high) / 2)

    return ease


def _power(exponent: int, x: float) -> float:
    return x**exponent


def _sine(x: float) -> float:
    return 1 - cos(x * pi / 2)


def _expo(x: float) -> float:
    return 0.0 if x <= 0 else 2.0 ** (10 * x - 10)


def _circ(x: float) -> float:
    return 1 - sqrt(max(0.0, 1 - x * x))


def _back(x: float) -> float:
    return 2.70158 * x**3 - 1.70158 * x * x


def _elastic(x: float) -> float:
    return x if x in (0.0, 1.0) else -(2.0 ** (10 * x - 10)) * sin((10 * x - 10.75) * 2 * pi / 3)


def _bounce(x: float) -> float:
    """What comes to rest, backwards."""
    y = 1 - x
    for start, middle, rest in (
        (1 / 2.75, 0.0, 0.0),
        (2 / 2.75, 1.5 / 2.75, 0.75),
        (2.5 / 2.75, 2.25 / 2.75, 0.9375),
        (2.0, 2.625 / 2.75, 0.984375),
    ):
        if y < start:
            return 1 - (7.5625 * (y - middle) ** 2 + rest)
    return 0.0


def _out(ease: Easing, x: float) -> float:
    return 1 - ease(1 - x)


def _in_out(ease: Easing, x: float) -> float:
    return ease(2 * x) / 2 if x < 0.5 else 1 - ease(2 - 2 * x) / 2


_FAMILIES: dict[str, Easing] = {
    "sine": _sine,
    "quad": partial(_power, 2),
    "cubic": partial(_power, 3),
    "quart": partial(_power, 4),
    "quint": partial(_power, 5),
    "expo": _expo,
    "circ": _circ,
    "back": _back,
    "elastic": _elastic,
    "bounce": _bounce,
}
_COMING_TO_REST = ("back", "elastic", "bounce")
"""Families whose name alone means that they swing at the end; that of others, at both ends."""


def _table() -> dict[str, Easing]:
    """All easings by name."""
    found: dict[str, Easing] = {
        "linear": lambda x: x,
        "step": lambda x: 0.0,
        "step-end": lambda x: 0.0,
        "step-start": lambda x: 1.0,
        "ease": _cubic_bezier(0.25, 0.1, 0.25, 1.0),
        "ease-in": _cubic_bezier(0.42, 0.0, 1.0, 1.0),
        "ease-out": _cubic_bezier(0.0, 0.0, 0.58, 1.0),
        "ease-in-out": _cubic_bezier(0.42, 0.0, 0.58, 1.0),
    }
    for name, ease in _FAMILIES.items():
        found[f"ease-in-{name}"] = ease
        found[f"ease-out-{name}"] = partial(_out, ease)
        found[f"ease-in-out-{name}"] = partial(_in_out, ease)
        found[name] = found[f"ease-{'out' if name in _COMING_TO_REST else 'in-out'}-{name}"]
    return found


EASINGS = _table()
"""By name, as CSS writes them."""
STEPS = frozenset({"step", "step-end", "step-start"})
"""Those that jump."""


def easing_name(written: str) -> str | None:
    """The name of an easing in the table, or None.

    Args:
        written: As CSS or Penner write it: `ease-in-out-cubic`, `easeInOutCubic`, `InOutCubic`.
    """
    dashed = re.sub(r"(?<=[a-z])(?=[A-Z])", "-", written).replace("_", "-").lower()
    for name in (dashed, f"ease-{dashed}"):
        if name in EASINGS:
            return name
    return None
