"""Parts of a picture that a person points at."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Area:
    """A disc, or the inside of a polygon of any shape."""

    at: tuple[float, float] = (0.0, 0.0)
    """Centre of the disc [px]."""
    radius: float = 0.0
    """Its radius [px]."""
    polygon: tuple[tuple[float, float], ...] = ()
    """Corners of the polygon [px], in place of a disc; or none."""


@dataclass(frozen=True)
class Stroke:
    """Where a person says that errors count more."""

    area: Area
    """There."""
    strength: float
    """How much it adds [1]."""
