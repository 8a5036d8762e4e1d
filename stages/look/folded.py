"""Pictures that wait, in little memory: what is drawn of triangles has long runs of one colour."""

import zlib
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Folded:
    """A picture that waits."""

    content: bytes
    """Its code values, deflated."""
    shape: tuple[int, ...]
    """Rows, columns, channels."""

    @classmethod
    def of(cls, pixels: np.ndarray) -> "Folded":
        """Let a picture wait.

        Args:
            pixels: Code values, uint8.
        """
        return cls(zlib.compress(np.ascontiguousarray(pixels).data, 1), pixels.shape)

    def pixels(self) -> np.ndarray:
        """The picture, uint8."""
        content = np.frombuffer(zlib.decompress(self.content), np.uint8)
        return content.reshape(self.shape)
