"""Where a cluster is, and how it is reached."""

import logging
import os
import re
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from warp_kernels.device.kernel_cache import settle_cache
from warp_kernels.errors import OptionError, TrimotionError

PATIENCE = 60.0
"""How long to wait for the scheduler [s]."""
SPARING = {
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.tick.limit": "30s",
    "distributed.worker.profile.enabled": False,
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.admin.system-monitor.disk": False,
}
"""What Dask would do beside the work, some hundred times a second, for a page that nobody opens."""
_LOCAL = re.compile(r"local:(\d+)")


@contextmanager
def connected(address: str) -> Iterator[Any]:
    """A client of a cluster while the block runs.

    Args:
        address: `tcp://HOST:PORT` and whatever else Dask knows, the name of a scheduler's file, or
            `local:N` for N workers on this machine, which end with the block.

    Raises:
        OptionError: If the package is missing.
        TrimotionError: If nothing answers there.
    """
    distributed = _imported(address)
    for name in ("distributed", "distributed.client"):  # what is lost is told in a line
        logging.getLogger(name).setLevel(logging.CRITICAL)
    local = _LOCAL.fullmatch(address)
    with ExitStack() as stack, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Dask's own about versions: those that matter are compared
        try:
            if local:
                target = stack.enter_context(_local(distributed, int(local[1])))
                client = distributed.Client(target, set_as_default=False)
            elif Path(address).is_file():
                client = distributed.Client(
                    scheduler_file=address, timeout=PATIENCE, set_as_default=False
                )
            else:
                client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            reason = " ".join(str(error).split()) or "no answer"
            raise TrimotionError(
                f"--cluster {address}: nothing answers there ({reason}); give the address that "
                "dask scheduler prints, its --scheduler-file, or local:N"
            ) from error
        stack.callback(client.close)
        yield client


def _imported(address: str) -> Any:
    """The package, which is no part of a plain installation."""
    try:
        import distributed
    except ImportError as error:
        raise OptionError(
            f"--cluster {address}: needs Dask, which is not installed; run pip install "
            "'trimotion[dask]', or use --jobs N on this machine"
        ) from error
    return distributed


def _local(distributed: Any, count: int) -> Any:
    """Workers on this machine, which share its cores."""
    import dask

    settle_cache()  # once for all of them
    with dask.config.set(SPARING):
        return distributed.LocalCluster(
            n_workers=count,
            threads_per_worker=max(1, (os.cpu_count() or 1) // count),
            processes=True,
            memory_limit=0,  # it would end a worker at a share of what is there; nothing is kept
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        )
