"""Where and in how many threads and processes the work is done: nothing that changes a result."""

import re
from dataclasses import dataclass, field

from warp_kernels.errors import OptionError

MAX_THREADS = 1024
"""More than any machine has cores; beyond it a number is a mistake."""

_DEVICE = re.compile(r"auto|cpu|cuda(:\d+)?|cuda-emulated")


@dataclass(frozen=True)
class Run:
    """What a run may use of the machine.

    Raises:
        OptionError: If an option has an impossible value.
    """

    device: str = field(
        default="auto",
        metadata={"help": "where kernels run", "metavar": "auto|cpu|cuda:N", "group": "run"},
    )
    """`auto`, `cpu` or `cuda:N`."""
    threads: int = field(
        default=0, metadata={"help": "threads of the CPU, 0 for one per core", "group": "run"}
    )
    """Threads of the CPU, 0 for one per core."""
    jobs: int = field(
        default=1, metadata={"help": "processes, each for whole shots", "group": "processes"}
    )
    """Number of processes."""
    cluster: str | None = field(
        default=None,
        metadata={
            "help": "shots go to the workers of a Dask cluster: tcp://HOST:PORT, a scheduler's "
            "file, or local:N",
            "metavar": "ADDRESS",
            "group": "processes",
        },
    )
    """Where a cluster is, or None."""
    report: str | None = field(
        default=None,
        metadata={
            "help": "also write what came of the run: options, versions, figures of every frame, "
            "times, warnings; .html holds pictures and plots",
            "metavar": "FILE.json|FILE.html",
            "group": "output",
        },
    )
    """The report that is written, or None; figures of frames are kept for it alone."""

    def __post_init__(self) -> None:
        if not _DEVICE.fullmatch(self.device):
            raise OptionError(f"--device {self.device}: unknown; use auto, cpu or cuda:N")
        if not 0 <= self.threads <= MAX_THREADS:
            raise OptionError(
                f"--threads {self.threads}: must lie between 0 (one per core) and {MAX_THREADS}"
            )
        if not 1 <= self.jobs <= MAX_THREADS:
            raise OptionError(f"--jobs {self.jobs}: must lie between 1 and {MAX_THREADS}")
        if self.cluster is not None and self.jobs > 1:
            raise OptionError(
                f"--cluster {self.cluster}: its workers are the processes; leave --jobs out"
            )
        if self.cluster is not None and self.cluster.startswith("local:"):
            count = self.cluster.removeprefix("local:")
            if not (count.isdecimal() and 1 <= int(count) <= MAX_THREADS):
                raise OptionError(
                    f"--cluster {self.cluster}: write local:N, with N from 1 to {MAX_THREADS}"
                )
