"""What draws the frames of a job: to pixels or to shapes, as the output's ending says."""

from pipeline.look.drawing import Drawing, check_drawing
from pipeline.look.exporting import Exporting, check_exporting
from pipeline.options.job import Job
from pipeline.stage_times import StageTimes
from stages.exchange import ending_of, is_exchange
from stages.media import MediaInfo
from warp_kernels.device.device import Device


def open_drawing(
    job: Job, info: MediaInfo, device: Device, times: StageTimes
) -> Drawing | Exporting:
    """Open the output of a job.

    Args:
        job: Says how the output looks and how it is written.
        info: The source; gives times, pixel aspect and sound.
        device: Where kernels run.
        times: Told how long encoding takes.

    Raises:
        OptionError: If an option does not fit the source or the format.
        OutputError: If the output cannot be written.
    """
    if job.output.path is not None and is_exchange(job.output.path):
        return Exporting(job, info)
    return Drawing(job, info, device, times)


def check_output_of(job: Job, info: MediaInfo, triangles: int | None = None) -> None:
    """Find out before any work is done whether the output of a job can be written.

    Args:
        job: Says how the output looks and how it is written.
        info: The source.
        triangles: How many a frame will have at most, as far as is known.

    Raises:
        OptionError: If an option does not fit the source or the format.
        MediaError: If a mask cannot be read.
        OutputError: If the output cannot be written.
    """
    if job.output.path is not None and is_exchange(job.output.path):
        check_exporting(job, info, triangles)
    else:
        if job.output.path is not None:
            job.output.exchange.refuse_idle(ending_of(job.output.path))
        check_drawing(job, info)
