"""What a timeline says of meshes: for all frames of the source, whatever range is solved."""

from dataclasses import replace

from pipeline.options.course import Course, Steps
from pipeline.options.job import Job
from pipeline.timeline.show import Show
from pipeline.timeline.staging import show_of
from pipeline.timeline.targets import MESH
from pipeline.timeline.timeline import Timeline
from stages.media import count_frames, probe
from warp_kernels.errors import OptionError


def with_course(job: Job) -> Job:
    """The same job with what its timeline says of meshes.

    Args:
        job: The job.

    Raises:
        OptionError: If the timeline does not fit the source.
        MediaError: If the source cannot be read.
    """
    timeline, options = job.look.score, job.solve
    if not isinstance(timeline, Timeline) or not timeline.changes_meshes:
        return job
    if options.triangulate.refine.quality is not None and timeline.changes("triangles"):
        raise OptionError("--quality: the timeline says how many triangles there are; leave it out")
    info = probe(options.source, read=options.read)
    if info.frame_count is None:
        info = replace(info, frame_count=count_frames(options.source, options.read))
    show = show_of(job.look, options.model, info)
    assert show is not None
    first, last = info.first_frame, info.last_frame or info.first_frame
    show.check(first, last, is_drawn=job.output.path is not None)
    found = {f"of_{name.split('.')[0]}": _steps(show, name, first, last) for name in MESH}
    return replace(job, solve=replace(options, course=Course(**found)))


def _steps(show: Show, name: str, first: int, last: int) -> Steps:
    """The values of all frames, where they differ from those before.

    A frame about which nothing is said has the value of the options, which stands in no step: what
    begins in the middle of a film begins there for good.
    """
    steps: list[tuple[int, float]] = []
    for index in range(first, last + 1):
        value = show.mesh_at(index, name)
        if value is not None and (not steps or steps[-1][1] != value):
            steps.append((index, value))
    return tuple(steps)
