"""What decides how high a mesh stands."""

from dataclasses import dataclass
from math import isfinite

from warp_kernels.errors import OptionError

MOST = 10.0
"""Most that a relief is high, in longer sides of the picture."""


@dataclass(frozen=True)
class Relief:
    """How high what is bright stands.

    Raises:
        OptionError: From `parse`, if the text has another form.
    """

    height: float
    """From black to white, as a share of the picture's longer side; below 0 black is on top."""
    path: str | None
    """A picture that tells the heights; None for the colours of the triangles."""

    @classmethod
    def parse(cls, text: str | float) -> "Relief":
        """Read `0.2` or `0.2:depth.png`.

        Args:
            text: As the user wrote it.
        """
        share, _, path = str(text).partition(":")
        try:
            height = float(share)
        except ValueError:
            height = 0.0
        if not (isfinite(height) and 0 < abs(height) <= MOST):
            raise OptionError(
                f"--relief {text}: write a height from -{MOST:g} to {MOST:g}, not 0, such as 0.2, "
                "and perhaps a picture of depth, such as 0.2:depth.png"
            )
        return cls(height, path or None)
