"""What all moves have in common: how far they have gone at a time."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from warp_kernels.styles.parameters import check_parameters

if TYPE_CHECKING:
    from stages.moves.pose import Pose, Resting


@dataclass(frozen=True, kw_only=True)
class Move:
    """A way in which triangles move while they are drawn.

    The help imports all moves, so their modules are light: methods import what they need.

    Parameters are fields; their metadata say what they may be, see `parameters`.

    Raises:
        OptionError: If a parameter is out of its range.
    """

    amount: float | None = field(
        default=1.0, metadata={"help": "how strong it is, 0 at rest", "range": (0.0, 10.0)}
    )

    def __post_init__(self) -> None:
        check_parameters(self)

    @property
    def wants_time(self) -> bool:
        """Whether it runs by itself, so that a still has no moment for it."""
        return False

    @property
    def is_idle(self) -> bool:
        """Whether it never does anything."""
        return self.amount == 0.0

    def amount_at(self, time: float) -> float:
        """How far it has gone; at 0 every triangle is where it lies.

        Args:
            time: Since the beginning of the film [s].
        """
        return 1.0 if self.amount is None else self.amount

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """Where triangles are drawn.

        Whatever it does follows from the ids of triangles and of vertices, from where they lie and
        from the time: any frame can be drawn alone.

        Args:
            pose: Where the moves before this one have brought them.
            resting: The frame.
            amount: How far it has gone, not 0.
        """
        raise NotImplementedError
