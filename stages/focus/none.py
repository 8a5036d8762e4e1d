"""No focus: all pixels count alike."""

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class NoFocus:
    """All pixels count alike."""

    strength: ClassVar[float] = 0.0
    """It adds nothing."""
