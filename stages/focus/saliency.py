"""What stands out of a still picture."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from stages.focus.strength import Strength

if TYPE_CHECKING:
    import numpy as np

    from stages.frame import Frame

LINES = 64
"""Size of the copy that is looked at [px]: what stands out does so from afar."""
BLUR = 2.5
"""Standard deviation of the blur of the map [px of that copy]."""
TOP = 99.0
"""Percentile of the map that counts as 1."""


@dataclass(frozen=True)
class Saliency(Strength):
    """Errors count more where the picture differs from what its spectrum lets expect.

    Source: Hou & Zhang, Saliency Detection: A Spectral Residual Approach (2007).
    """

    def glance(self, before: "Frame | None", frame: "Frame") -> "np.ndarray":
        """Spectral residual of the picture.

        Args:
            before: Not looked at.
            frame: The picture.

        Returns:
            [h, w] float32, 0 to 1.
        """
        import cv2
        import numpy as np

        grey = cv2.cvtColor(frame.pixels, cv2.COLOR_RGB2GRAY)
        copy = cv2.resize(grey, (LINES, LINES), interpolation=cv2.INTER_AREA).astype(np.float32)
        spectrum = np.fft.fft2(copy)
        strength = np.log(np.abs(spectrum) + 1e-3).astype(np.float32)
        residual = strength - cv2.blur(strength, (3, 3), borderType=cv2.BORDER_WRAP)
        unusual = np.abs(np.fft.ifft2(np.exp(residual + 1j * np.angle(spectrum)))) ** 2
        blurred = cv2.GaussianBlur(unusual.astype(np.float32), (0, 0), BLUR)
        blurred = blurred - blurred.min()
        top = float(np.percentile(blurred, TOP))
        if top <= 1e-12 or copy.std() < 1.0:  # a flat picture: nothing stands out
            return np.zeros_like(blurred)
        return np.minimum(blurred / np.float32(top), 1.0)
