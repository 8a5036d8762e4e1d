"""Triangles that swell on a beat."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stages.moves.move import Move

if TYPE_CHECKING:
    from stages.moves.pose import Pose, Resting


@dataclass(frozen=True)
class Pulse(Move):
    """Triangles swell or shrink on a beat, turn a little and shine, and the picture comes nearer.

    Without a curve it beats by itself, `every` so many seconds.
    """

    amount: float | None = field(
        default=None,
        metadata={
            "help": "how far it has gone, 0 at rest; by itself if left out",
            "range": (0.0, 10.0),
        },
    )
    every: float = field(
        default=0.5,
        metadata={"help": "time between its own beats", "unit": "s", "range": (0.05, 3600.0)},
    )
    size: float = field(
        default=-0.3,
        metadata={
            "help": "by what part triangles grow, below 0 shrink",
            "range": (-1.0, 4.0),
        },
    )
    zoom: float = field(
        default=0.04,
        metadata={"help": "by what part the picture grows", "range": (-0.9, 4.0)},
    )
    turn: float = field(
        default=0.03,
        metadata={"help": "how far triangles turn", "unit": "turns", "range": (0.0, 1.0)},
    )
    shine: float = field(
        default=0.15, metadata={"help": "how much brighter they become", "range": (0.0, 1.0)}
    )
    vary: float = field(default=0.7, metadata={"help": "how unlike they are", "range": (0.0, 1.0)})
    x: float = field(
        default=0.5,
        metadata={"help": "what stays in place", "unit": "of the width", "range": (-1.0, 2.0)},
    )
    y: float = field(
        default=0.5,
        metadata={"help": "what stays in place", "unit": "of the height", "range": (-1.0, 2.0)},
    )

    def amount_at(self, time: float) -> float:
        """What was given, or a beat that dies away and sets in softly."""
        if self.amount is not None:
            return self.amount
        phase = time / self.every % 1.0
        rise = min(max((phase - 0.9) / 0.1, 0.0), 1.0)
        return max((1.0 - phase) ** 3, rise * rise * (3.0 - 2.0 * rise))

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """Each about its own centre, all about the point."""
        import numpy as np

        from stages.moves.tilt import spun

        own = amount * (1.0 - self.vary * resting.chance(1))
        zoom = 1.0 + self.zoom * amount
        grown = np.maximum(1.0 + self.size * own, 0.0) * zoom
        spins = 4.0 * np.pi * self.turn * own * (resting.chance(2) - 0.5)
        shift = (zoom - 1.0) * (resting.centres - resting.point(self.x, self.y))
        carried = pose.carried(spun(spins) * grown[:, None, None], shift)
        return carried.shown(light=1.0 + self.shine * own, nearer=0.01 * own)
