"""How the number of triangles develops while a first frame is refined."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Growth:
    """A course from the layout to the wanted number of triangles, which it may overshoot."""

    start: float
    """Triangles that the layout places, as a part of the wanted number."""
    peak: float
    """Largest number of triangles on the way, as a part of the wanted number."""
    grown: float
    """Part of the refinement after which the peak is reached."""
    settled: float
    """Part of the refinement after which the wanted number is reached."""

    def count(self, progress: float, wanted: int) -> int:
        """How many triangles there should be, growing and falling by equal factors.

        Args:
            progress: Part of the refinement that is done, 0 to 1.
            wanted: Number of triangles in the end.
        """
        if progress < self.grown:
            return round(wanted * self.start * (self.peak / self.start) ** (progress / self.grown))
        if progress < self.settled:
            left = (self.settled - progress) / (self.settled - self.grown)
            return round(wanted * self.peak**left)
        return wanted
