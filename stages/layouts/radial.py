"""The radial layout: rings around a point, like a spider's web."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

    from stages.mesh import Mesh

LEAST_STEP = 0.05
"""Rings lie no nearer to each other than this part of the usual spacing."""


@dataclass(frozen=True)
class Radial:
    """Rings of points around a centre, each turned by half a step, nearer to each other inside.

    Raises:
        OptionError: If a number is out of its range.
    """

    center_x: float = field(default=0.5)
    """Centre across, as a part of the width [0..1]."""
    center_y: float = field(default=0.5)
    """Centre down, as a part of the height [0..1]."""
    focus: float = field(default=0.5)
    """How much smaller triangles are at the centre: 0 for rings that are equally far apart, 1 for
    those of a web, whose points lie on rays [0..1]."""

    def __post_init__(self) -> None:
        check_shares(self, "center_x", "center_y", "focus")

    def build(
        self, pixels: "np.ndarray", triangle_count: int, rng: "np.random.Generator"
    ) -> "Mesh":
        """Lay the rings over a picture.

        Args:
            pixels: The picture, shape [H, W, 3] uint8; only its size matters.
            triangle_count: Wanted number of triangles.
            rng: Not used.
        """
        import numpy as np

        from stages.layouts.even_points import fitted_mesh

        height, width = pixels.shape[:2]
        size = np.array([width, height])
        center = np.array([self.center_x, self.center_y]) * size
        reach = float(np.linalg.norm(np.maximum(center, size - center)))

        def rings(spacing: float) -> np.ndarray:
            """Points of all rings, the centre first."""
            found, radius, number = [center[None]], 0.0, 0
            while radius < reach:
                step = spacing * max((radius + spacing) / reach, LEAST_STEP) ** self.focus
                step *= (
                    1.0 + self.focus
                ) ** 0.5  # where they are close inside they are far outside
                radius += step * np.sqrt(3.0) / 2.0
                count = max(6, round(2.0 * np.pi * radius / step))
                angles = 2.0 * np.pi * (np.arange(count) + 0.5 * (number % 2)) / count
                around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
                found.append(center + radius * around)
                number += 1
            return np.concatenate(found)

        return fitted_mesh(pixels, triangle_count, rings)


def check_shares(layout: object, *names: str) -> None:
    """Refuse numbers that are no parts of a whole.

    Raises:
        OptionError: If one is below 0 or above 1.
    """
    for name in names:
        value = getattr(layout, name)
        if not 0.0 <= value <= 1.0:
            raise OptionError(f"{name}={value:g}: must lie between 0 and 1")
