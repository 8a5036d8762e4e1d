"""A picture that builds up from nothing."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from stages.moves.passing import Passing

if TYPE_CHECKING:
    import numpy as np

    from stages.moves.pose import Pose, Resting

ORDERS = ("size", "distance", "brightness", "random", "left", "right", "up", "down")
"""What decides whose turn it is."""
WAYS = ("fly", "drop", "grow", "turn")
"""How triangles come."""


@dataclass(frozen=True)
class Assemble(Passing):
    """The picture builds up from nothing, triangle after triangle: the classic title.

    By itself it is whole after `seconds`; `back` takes it apart again. As a curve `amount` leads
    from 1, nothing, to 0, all of it.
    """

    order: str = field(
        default="size",
        metadata={"help": "large, near, dark ones first, or towards a side", "choices": ORDERS},
    )
    reverse: bool = field(default=False, metadata={"help": "the other way round"})
    way: str = field(default="fly", metadata={"help": "how they come", "choices": WAYS})
    x: float = field(
        default=0.5,
        metadata={"help": "distance from here", "unit": "of the width", "range": (-1.0, 2.0)},
    )
    y: float = field(
        default=0.5,
        metadata={"help": "distance from here", "unit": "of the height", "range": (-1.0, 2.0)},
    )
    turn: float = field(
        default=0.6, metadata={"help": "how far they tumble", "unit": "turns", "range": (0.0, 10.0)}
    )
    alone: float = field(
        default=0.3,
        metadata={
            "help": "how long each is on its way",
            "unit": "of the time",
            "range": (0.01, 1.0),
        },
    )

    begins_at_rest: ClassVar[bool] = False

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """Each waits for its turn, comes, and stays."""
        import numpy as np

        from stages.moves.easing import arriving, landing, one_by_one, springing
        from stages.moves.tilt import tilted

        way = one_by_one(1.0 - amount, self._turns(resting), self.alone)
        eases = {"fly": arriving, "drop": landing, "grow": springing, "turn": arriving}
        left = 1.0 - eases[self.way](way)
        shift, zoom = np.zeros_like(resting.centres), np.ones_like(way)
        turns = spins = np.zeros_like(way)
        if self.way == "fly":
            away = resting.centres - resting.point(self.x, self.y)
            angle = np.arctan2(away[:, 1], away[:, 0]) + 1.2 * (resting.chance(2) - 0.5)
            far = resting.diagonal * (0.25 + 0.35 * resting.chance(3)) * left
            shift = far[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            zoom = 1.0 + 0.8 * left
            turns = 2.0 * np.pi * self.turn * left * (0.5 + resting.chance(5))
            spins = (resting.chance(7) - 0.5) * turns
        elif self.way == "drop":
            shift[:, 1] -= (0.5 + 0.4 * resting.chance(3)) * resting.size[1] * left
            spins = 0.6 * self.turn * (resting.chance(7) - 0.5) * 2.0 * np.pi * left
        elif self.way == "grow":
            zoom = np.maximum(1.0 - left, 0.0)
            spins = self.turn * (resting.chance(7) - 0.5) * 2.0 * np.pi * left
        else:
            turns = 0.5 * np.pi * left
        linear, light = tilted(2.0 * np.pi * resting.chance(6), turns, spins)
        carried = pose.carried(linear * zoom[:, None, None], shift)
        seen = np.minimum(way * 5.0, 1.0)
        return carried.shown(
            presence=seen, light=light, nearer=np.where(way < 1.0, 1.0 + left, 0.0)
        )

    def _turns(self, resting: "Resting") -> "np.ndarray":
        """Whose turn it is when, from 0 for the first to 1 for the last, [T]."""
        import numpy as np

        from stages.moves.easing import ranked

        x, y = resting.centres.T
        away = resting.centres - resting.point(self.x, self.y)
        keys = {
            "size": lambda: -resting.areas,
            "distance": lambda: np.sqrt((away**2).sum(axis=1)),
            "brightness": lambda: resting.brightness,
            "random": lambda: resting.chance(1),
            "left": lambda: -x,
            "right": lambda: x,
            "up": lambda: -y,
            "down": lambda: y,
        }
        turns = ranked(keys[self.order](), resting.ids)
        # a little out of line: nothing in a row looks like a curtain
        turns = 0.88 * turns + 0.12 * resting.chance(1)
        return 1.0 - turns if self.reverse else turns
