"""Values over time as few keyframes between which a player goes straight."""

from typing import Any

import numpy as np


def kept(times: np.ndarray, values: np.ndarray, tolerance: float) -> list[int]:
    """Which frames must be keyframes so that none of the others is farther off than allowed.

    Args:
        times: Of the frames, ascending, [N].
        values: At them, [N, K].
        tolerance: Most that any value may be off.

    Returns:
        Frames, ascending; the first and the last one among them.

    Source: Douglas & Peucker (1973), with the largest difference of any value as the distance.
    """
    last = len(times) - 1
    found, waiting = {0, last}, [(0, last)]
    while waiting:
        begin, end = waiting.pop()
        if end - begin < 2:
            continue
        share = (times[begin + 1 : end] - times[begin]) / (times[end] - times[begin])
        line = values[begin] + share[:, None] * (values[end] - values[begin])
        off = np.abs(values[begin + 1 : end] - line).max(axis=1)
        worst = int(off.argmax())
        if off[worst] > tolerance:
            middle = begin + 1 + worst
            found.add(middle)
            waiting += [(begin, middle), (middle, end)]
    return sorted(found)


def animated(times: np.ndarray, values: list[Any], still: Any) -> dict[str, Any]:
    """A property of Lottie.

    Args:
        times: Of the keyframes [frames].
        values: At them, as keyframes have them.
        still: The first one as a property without keyframes has it.
    """
    if all(value == values[0] for value in values):
        return {"a": 0, "k": still}
    keyframes: list[dict[str, Any]] = [
        {"t": short(time), "s": value, "o": {"x": 0, "y": 0}, "i": {"x": 1, "y": 1}}
        for time, value in zip(times.tolist(), values, strict=True)
    ]
    del keyframes[-1]["o"], keyframes[-1]["i"]
    return {"a": 1, "k": keyframes}


def short(number: float) -> float:
    """The same number, without a point where it is whole."""
    return int(number) if number == int(number) else number
