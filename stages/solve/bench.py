"""What one picture is worked on with: device memory, and what measures and optimises in it."""

from dataclasses import dataclass

import numpy as np

from stages.solve.approximate import Approximator
from stages.topology.appraise import Appraiser
from warp_kernels.energy.workspace import Workspace


@dataclass(frozen=True, eq=False)
class Bench:
    """A workspace and those that work in it."""

    workspace: Workspace
    """Device memory, for pictures with weights or for those without."""
    appraiser: Appraiser
    """Measures meshes in `workspace`."""
    approximator: Approximator
    """Optimises meshes in `workspace`."""

    def load(self, pixels: np.ndarray, weights: np.ndarray | None = None) -> None:
        """Take in a picture.

        Args:
            pixels: Code values of the space of the error, [H, W, 3] uint8.
            weights: How much the error of every pixel counts, [H, W] uint8, or None.
        """
        self.workspace.load_image(pixels, weights)
        self.appraiser.forget()
