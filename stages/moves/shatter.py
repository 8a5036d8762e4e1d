"""A picture that breaks and falls."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.moves.passing import Passing

if TYPE_CHECKING:
    from stages.moves.pose import Pose, Resting


@dataclass(frozen=True)
class Shatter(Passing):
    """The picture cracks from where it is hit, and its pieces fall out of it.

    With `back` they return as they went.
    """

    x: float = field(
        default=0.5,
        metadata={"help": "where it is hit", "unit": "of the width", "range": (-1.0, 2.0)},
    )
    y: float = field(
        default=0.35,
        metadata={"help": "where it is hit", "unit": "of the height", "range": (-1.0, 2.0)},
    )
    force: float = field(default=0.5, metadata={"help": "how hard it is hit", "range": (0.0, 5.0)})
    turn: float = field(
        default=0.8, metadata={"help": "how far they tumble", "unit": "turns", "range": (0.0, 10.0)}
    )
    wait: float = field(
        default=0.5,
        metadata={
            "help": "how much later the last piece falls than the first",
            "unit": "of the time",
            "range": (0.0, 0.9),
        },
    )

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """Pieces are pushed, then gravity has them: at 1 the last has left the picture."""
        import numpy as np

        from stages.moves.tilt import tilted

        away = resting.centres - resting.point(self.x, self.y)
        distance = np.sqrt((away**2).sum(axis=1))
        reach = max(float(distance.max()), 1.0)
        late = self.wait * (0.7 * distance / reach + 0.3 * resting.chance(1))
        fall = np.maximum(amount - late, 0.0) / (1.0 - self.wait)
        push = self.force * fall * np.exp(-1.5 * distance / reach)
        outward = away / np.maximum(distance, 1e-9)[:, None]
        shift = (0.35 * resting.diagonal * push)[:, None] * outward
        shift[:, 0] += 0.1 * resting.diagonal * self.force * (resting.chance(2) - 0.5) * fall
        # what lies highest and falls last must still get out of the picture
        height = resting.size[1]
        shift[:, 1] += height * fall * (1.3 * (1.0 + 0.3 * resting.chance(3)) * fall - 0.1)
        nearer = 0.45 * push * (0.3 + resting.chance(4))
        zoom = 1.0 / (1.0 - np.clip(nearer, -6.0, 0.8))
        turns = 2.0 * np.pi * self.turn * fall * (0.4 + 1.2 * resting.chance(5))
        spins = 1.6 * (resting.chance(7) - 0.5) * turns
        linear, light = tilted(2.0 * np.pi * resting.chance(6), turns, spins)
        carried = pose.carried(linear * zoom[:, None, None], shift)
        return carried.shown(light=light, nearer=nearer)
