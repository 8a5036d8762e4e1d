"""Snapshots to frames of the output: drawn and encoded."""

from types import TracebackType

from pipeline.job import Job
from stages.media import MediaInfo, check_output, open_encoder
from stages.render import Renderer
from stages.snapshot import Snapshot
from warp_kernels.device import Device


class Drawing:
    """The output of a job; a context manager that leaves nothing under its name on a failure.

    Args:
        job: Says how the output looks and how it is written.
        info: The source; gives times, pixel aspect and sound.
        device: Where kernels run.

    Raises:
        OptionError: If an option does not fit the source.
        OutputError: If the output cannot be written.
    """

    def __init__(self, job: Job, info: MediaInfo, device: Device) -> None:
        picture = (info.width, info.height)
        size = job.size_for(picture)
        self._renderer = Renderer(device, picture, size, job.shown_styles)
        self._encoder = open_encoder(job.output, info, size, job.encode, job.frame_range)

    @property
    def notes(self) -> list[str]:
        """Choices that were made, one sentence each; complete after the block."""
        return self._encoder.notes

    def draw(self, snapshot: Snapshot) -> None:
        """Draw and encode a snapshot."""
        pixels = self._renderer.render(snapshot)
        self._encoder.write(pixels, snapshot.pts, snapshot.time_base, snapshot.frame_index)

    def __enter__(self) -> "Drawing":
        self._encoder.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._encoder.__exit__(kind, error, trace)


def check_drawing(job: Job, info: MediaInfo) -> None:
    """Find out before any work is done whether the output can be written.

    Args:
        job: Says how the output looks and how it is written.
        info: The source.

    Raises:
        OptionError: If an option does not fit the source.
        OutputError: If the output cannot be written.
    """
    size = job.size_for((info.width, info.height))
    check_output(job.output, info, size, job.encode, job.frame_range)
