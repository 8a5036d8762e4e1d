"""The device of a call: opened for it, and closed with it."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from warp_kernels.device.device import Device


@contextmanager
def opened_device(name: str, threads: int) -> Iterator[Device]:
    """A device whose threads end with the block.

    Args:
        name: `auto`, `cpu` or `cuda:N`.
        threads: Threads of the CPU, 0 for one per core.

    Raises:
        OptionError: If there is no such device.
    """
    device: Any = Device(name, threads)
    try:
        yield device
    finally:
        close = getattr(device, "close", None)
        if close is not None:
            close()
