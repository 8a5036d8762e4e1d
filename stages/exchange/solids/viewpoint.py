"""Where the camera stands from which a mesh is the picture."""

from dataclasses import dataclass

from stages.exchange.film import Film

METRES = 0.001
"""Length of a pixel: a picture becomes as large as a print of it."""


@dataclass(frozen=True)
class Viewpoint:
    """A place above the middle of the picture; what is seen does not depend on how high it is."""

    distance: float
    """Above black, or the plane of a flat picture [px]."""
    near: float
    """Where sight begins, from the camera [px]."""
    far: float
    """Where it ends [px]."""

    @classmethod
    def of(cls, film: Film) -> "Viewpoint":
        """High enough above all that a film shows.

        Args:
            film: Gives the size and the relief.
        """
        side, relief = max(film.size), film.options.heights
        top = 0.0 if relief is None else abs(relief.height) * side
        return cls(top + side, side / 8, top + 2 * side)
