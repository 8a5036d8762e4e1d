"""Whose turn it is to use one way to a card, and what is said when its memory has run out."""

import re
from threading import RLock
from types import TracebackType

from warp_kernels.errors import TrimotionError

_FULL = re.compile(r"failed to allocate|out of memory", re.IGNORECASE)
"""What Warp and CUDA say of a full card, among all else that they raise as the same type."""


class Turn:
    """Held while one uses a card; whoever holds it may take it again.

    Allocations say what would fit. Everything else that takes memory of a card, such as graphs and
    what kernels spill, is found out by the error alone.

    Args:
        name: The device.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._lock = RLock()

    def __enter__(self) -> None:
        self._lock.acquire()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._lock.release()
        if isinstance(error, RuntimeError) and _FULL.search(str(error)):
            raise TrimotionError(
                f"--device {self._name}: out of memory; end other programs that use the card, or "
                "use a smaller --scale, fewer --triangles or --device cpu"
            ) from error
