"""Waves that run through the picture."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from stages.moves.move import Move

if TYPE_CHECKING:
    import numpy as np

    from stages.moves.pose import Pose, Resting

MOST_MARGIN = 0.25
"""Waves are held back no farther from the border than this part of the shorter side."""


@dataclass(frozen=True)
class Wave(Move):
    """Waves run through the picture as through a flag, or as rings from a point."""

    height: float = field(
        default=2.0,
        metadata={
            "help": "how far corners go",
            "unit": "% of the picture's shorter side",
            "range": (0.0, 100.0),
        },
    )
    length: float = field(
        default=50.0,
        metadata={
            "help": "from crest to crest",
            "unit": "% of the picture's shorter side",
            "range": (1.0, 1000.0),
        },
    )
    speed: float = field(
        default=0.6, metadata={"help": "crests a second", "range": (-100.0, 100.0)}
    )
    form: str = field(
        default="flag",
        metadata={"help": "what they look like", "choices": ("flag", "rings")},
    )
    angle: float = field(
        default=20.0,
        metadata={
            "help": "where those of a flag run, 0 to the right",
            "unit": "degrees",
            "range": (-360.0, 360.0),
        },
    )
    x: float = field(
        default=0.5,
        metadata={"help": "where rings begin", "unit": "of the width", "range": (-1.0, 2.0)},
    )
    y: float = field(
        default=0.5,
        metadata={"help": "where rings begin", "unit": "of the height", "range": (-1.0, 2.0)},
    )
    shine: float = field(
        default=0.25, metadata={"help": "how bright and dark slopes are", "range": (0.0, 1.0)}
    )
    free: bool = field(default=False, metadata={"help": "the border of the picture moves along"})

    def moved(self, pose: "Pose", resting: "Resting", amount: float) -> "Pose":
        """What depends on the place alone moves corners that meet together."""
        import numpy as np

        from stages.moves.borders import within

        height = amount * self.height / 100.0 * resting.shorter
        direction, phase = self._phase(resting, pose.corners)
        away = height * np.sin(phase)[..., None] * direction
        if not self.free:
            margin = min(max(4.0 * height, 1.0), MOST_MARGIN * resting.shorter)
            away *= within(resting.corners, resting.size, margin)
        _, middle = self._phase(resting, pose.corners.mean(axis=1))
        light = 1.0 + min(amount, 1.0) * self.shine * np.cos(middle)
        return replace(pose, corners=pose.corners + away).shown(light=light)

    def _phase(self, resting: "Resting", places: "np.ndarray") -> tuple["np.ndarray", "np.ndarray"]:
        """Where corners go at some places [..., 2], and how far in its course a wave is [...]."""
        import numpy as np

        length = self.length / 100.0 * resting.shorter
        run = 2.0 * np.pi * (self.speed * resting.time)
        if self.form == "rings":
            away = places - resting.point(self.x, self.y)
            distance = np.sqrt((away**2).sum(axis=-1))
            # in the middle of the rings there is no direction to go
            calm = np.minimum(distance / (0.25 * length), 1.0) / np.maximum(distance, 1e-9)
            return away * calm[..., None], 2.0 * np.pi * distance / length - run
        angle = np.radians(self.angle)
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]])
        return np.broadcast_to(across, places.shape), 2.0 * np.pi * (places @ along) / length - run
