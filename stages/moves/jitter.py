"""The boil of hand-drawn film."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from stages.moves.move import Move

if TYPE_CHECKING:
    from stages.moves.pose import Pose, Resting


@dataclass(frozen=True)
class Jitter(Move):
    """Corners tremble, as if every few frames were drawn by hand anew."""

    reach: float = field(
        default=0.6,
        metadata={
            "help": "how far corners go",
            "unit": "% of the picture's shorter side",
            "range": (0.0, 50.0),
        },
    )
    hold: int = field(
        default=3,
        metadata={"help": "how long each drawing is held", "unit": "frames", "range": (1, 1000)},
    )
    loose: bool = field(
        default=False, metadata={"help": "triangles tremble one by one, with gaps between them"}
    )

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """The corners that meet at a vertex stay together; those on the border stay there."""
        import numpy as np

        from stages.moves.borders import within
        from stages.moves.pose import chances

        ids = resting.vertex_ids
        if self.loose:
            ids = 4 * resting.ids[:, None] + np.arange(3)
        drawing = 2 * (resting.frame // self.hold)
        angle = 2.0 * np.pi * chances(ids, drawing)
        far = amount * self.reach / 100.0 * resting.shorter * np.sqrt(chances(ids, drawing + 1))
        away = far[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        if not self.loose:
            margin = 3.0 * amount * self.reach / 100.0 * resting.shorter
            away *= within(resting.corners, resting.size, margin)
        return replace(pose, corners=pose.corners + away)
