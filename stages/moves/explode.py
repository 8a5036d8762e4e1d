"""Triangles that fly apart."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.moves.passing import Passing

if TYPE_CHECKING:
    from stages.moves.pose import Pose, Resting


@dataclass(frozen=True)
class Explode(Passing):
    """Triangles fly away from a point, through space and tumbling, those beside it first."""

    x: float = field(
        default=0.5,
        metadata={"help": "where the point is", "unit": "of the width", "range": (-1.0, 2.0)},
    )
    y: float = field(
        default=0.5,
        metadata={"help": "where the point is", "unit": "of the height", "range": (-1.0, 2.0)},
    )
    spread: float = field(default=1.0, metadata={"help": "how far they fly", "range": (0.0, 10.0)})
    turn: float = field(
        default=0.7, metadata={"help": "how far they tumble", "unit": "turns", "range": (0.0, 10.0)}
    )
    wait: float = field(
        default=0.4,
        metadata={
            "help": "how much later those begin that lie farthest away",
            "unit": "of the time",
            "range": (0.0, 0.9),
        },
    )
    chaos: float = field(
        default=0.5, metadata={"help": "how unlike their ways are", "range": (0.0, 1.0)}
    )

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """Along straight lines in space, at a speed that is reached little by little."""
        import numpy as np

        from stages.moves.tilt import tilted

        point, size = resting.point(self.x, self.y), resting.diagonal
        away = resting.centres - point
        distance = np.sqrt((away**2).sum(axis=1))
        late = self.wait * np.minimum(
            distance / size + 0.3 * self.chaos * (resting.chance(1) - 0.5), 1.0
        )
        run = np.maximum(amount - np.maximum(late, 0.0), 0.0) / (1.0 - self.wait)
        way = 1.1 * run * run / (run + 0.3)  # the speed is reached little by little
        bend = self.chaos * 1.6 * (resting.chance(2) - 0.5)
        angle = np.arctan2(away[:, 1], away[:, 0]) + bend
        speed = self.spread * size * (0.12 + self.chaos * 0.6 * resting.chance(3))
        nearer = self.spread * (0.1 + self.chaos * (resting.chance(4) - 0.5)) * way
        zoom = 1.0 / (1.0 - np.clip(nearer, -6.0, 0.8))
        shift = (way * speed)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        shift = (away + shift) * zoom[:, None] - away
        turns = 2.0 * np.pi * self.turn * way * (0.4 + 1.2 * resting.chance(5))
        spins = 2.0 * (resting.chance(7) - 0.5) * turns
        linear, light = tilted(2.0 * np.pi * resting.chance(6), turns, spins)
        carried = pose.carried(linear * zoom[:, None, None], shift)
        return carried.shown(light=light, nearer=nearer)
