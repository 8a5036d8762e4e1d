"""What is said when a card has no memory left: how much is missing, and what would fit."""

import math

STEP = 0.05
"""Scales that are proposed are multiples of it."""
RESERVE = 0.9
"""Share of the memory that is counted on: the driver needs some, and so do what kernels spill."""


def fitting_scale(taken: int, asked: int, free: int) -> float:
    """The scale of a picture whose arrays would fit, as memory grows with its area.

    Args:
        taken: Bytes that were taken for it so far.
        asked: Bytes of what did not fit.
        free: Bytes that are left on the card.

    Returns:
        A multiple of STEP below 1; 0 if not even the smallest fits.
    """
    share = RESERVE * (taken + free) / (taken + asked)
    return max(0.0, min(math.floor(math.sqrt(share) / STEP) * STEP, 1.0 - STEP))


def memory_problem(name: str, taken: int, asked: int, free: int) -> str:
    """One sentence with the remedy.

    Args:
        name: The device.
        taken: As in `fitting_scale`.
        asked: The same.
        free: The same.
    """
    scale = fitting_scale(taken, asked, free)
    smaller = f"--scale {scale:.2g} should fit, or use " if scale else "use "
    return (
        f"--device {name}: out of memory ({asked / 1e6:.0f} MB more are needed and "
        f"{free / 1e6:.0f} MB are free); {smaller}--device cpu"
    )
