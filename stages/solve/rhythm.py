"""How often a later frame looks at its topology, and when it is done."""

from dataclasses import dataclass

from stages.solve.convergence import Convergence


@dataclass(frozen=True)
class Rhythm:
    """The rounds of a later frame: some iterations, then one look at the topology."""

    round_length: int
    """Iterations between two looks at the topology."""
    saving: float
    """Once a round saves less than this part of the energy, the frame is done."""

    def spread(self, iterations: int) -> tuple[int, int]:
        """Looks at the topology, and iterations before, between and after them.

        Args:
            iterations: Most iterations of the frame.
        """
        looks = max(1, iterations // self.round_length - 1)
        return looks, iterations // (looks + 1)

    def watch(self) -> Convergence:
        """Watches one frame."""
        return Convergence(self.saving, patience=1)


CALM = Rhythm(round_length=4, saving=0.008)
"""Where little has changed one or two rounds are enough, where something moves fast more of them
are worth it. Each look moves more vertices elsewhere than it did when looks were many."""
BOILING = Rhythm(round_length=3, saving=0.0025)
"""Where the picture boils triangles have a long way to go."""
