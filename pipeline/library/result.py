"""What a finished run came to."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Result:
    """What a finished run came to."""

    output: Path
    """What was written."""
    frames: int
    """Frames that were written."""
    seconds: float
    """How long it took [s]."""
    mean_rmse: float
    """Mean over the frames of the root mean square error [code values]."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""
    warnings: tuple[str, ...]
    """Damage that was met, one sentence each."""
