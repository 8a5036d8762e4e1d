"""Moves that happen once: by themselves at some time, or as far as a curve says."""

from dataclasses import dataclass, field
from typing import ClassVar

from stages.moves.move import Move


@dataclass(frozen=True, kw_only=True)
class Passing(Move):
    """A move from one state to another, and back if that is asked for.

    Where `amount` is given, by a number or a curve, `start`, `seconds` and `back` mean nothing.
    """

    amount: float | None = field(
        default=None,
        metadata={
            "help": "how far it has gone, 0 at rest; by itself if left out",
            "range": (0.0, 1.0),
        },
    )
    start: float = field(
        default=0.0,
        metadata={"help": "when it begins by itself", "unit": "s", "range": (0.0, 1e6)},
    )
    seconds: float = field(
        default=2.0,
        metadata={"help": "how long it takes by itself", "unit": "s", "range": (0.01, 1e6)},
    )
    back: float | None = field(
        default=None,
        metadata={
            "help": "when it begins to go back; never if left out",
            "unit": "s",
            "range": (0.0, 1e6),
        },
    )

    begins_at_rest: ClassVar[bool] = True
    """Whether it leads away from where triangles lie, and not there."""

    @property
    def wants_time(self) -> bool:
        """Unless its amount is known."""
        return self.amount is None

    def amount_at(self, time: float) -> float:
        """What was given, or how much of its time is over."""
        if self.amount is not None:
            return self.amount
        way = min(max((time - self.start) / self.seconds, 0.0), 1.0)
        if self.back is not None:
            way = min(way, min(max(1.0 - (time - self.back) / self.seconds, 0.0), 1.0))
        return way if self.begins_at_rest else 1.0 - way
