"""Where the camera stands from which a mesh is the picture."""

from dataclasses import dataclass

from stages.exchange.film import Film

METRES = 0.001
"""Length of a pixel: a picture becomes as large as a print of it."""


@dataclass(frozen=True)
class Viewpoint:
    """A place above the middle of the picture from which all of it lies in sight."""

    distance: float
    """Above black, or the plane of a flat picture [px]."""
    free: float
    """Above what is highest [px]."""
    near: float
    """Where sight begins, from the camera [px]."""
    far: float
    """Where it ends [px]."""

    @classmethod
    def of(cls, film: Film) -> "Viewpoint":
        """Two longer sides above all that a film shows.

        Args:
            film: Gives the size and the relief.
        """
        side, relief = max(film.size), film.options.heights
        top = 0.0 if relief is None else abs(relief.height) * side
        return cls(top + 2 * side, 2 * side, side, top + 3 * side)
