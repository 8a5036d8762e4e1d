"""A mesh track to an output: frames are drawn that were solved before."""

from collections.abc import Iterator
from time import perf_counter

from pipeline.envelope import Solved
from pipeline.look.outputs import check_output_of, open_drawing
from pipeline.look.region_members import followed_shares
from pipeline.look.rows_around import rows_around
from pipeline.look.source_pictures import source_pictures
from pipeline.loop.convert import SOLVED_BEHIND, triangulator_of
from pipeline.loop.result import Animated, Tally
from pipeline.loop.threads import Behind
from pipeline.options.course import Course
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.timeline.timeline import Timeline
from pipeline.track import FrameRow, TrackReader
from stages.media import FrameRange, MediaInfo, open_decoder
from stages.snapshot import Snapshot
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device


def render(job: Job, track: TrackReader, info: MediaInfo, progress: Progress) -> Animated:
    """Draw a track.

    Args:
        job: What to do, with the options that the track was made with.
        track: Holds the snapshots.
        info: The track's source as far as it can still be read.
        progress: Told of every finished frame.

    Raises:
        MediaError: If the source is needed and cannot be read.
        OptionError: If an option does not fit the track.
        OutputError: If the output cannot be written.
        TrackError: If the track is damaged.
    """
    begun = perf_counter()
    check_output_of(job, info)
    options, look = job.solve, job.look
    device = Device(job.run.device, job.run.threads, progress.kernels)
    shown = track.rows_in(options.frame_range)
    rows = rows_around(track.rows, shown, options, look)
    tally = Tally(progress, len(shown))
    drawing = open_drawing(job, info, device)
    with device, drawing, Behind(drawing.draw, SOLVED_BEHIND) as writer:
        fitted = _fitted(track, rows, options, job.fitted, device)
        sources = source_pictures(options, look, rows)
        shares = followed_shares(options, look, track, rows)
        for snapshot, row, source, share in zip(fitted, rows, sources, shares, strict=True):
            is_shown = shown[0].frame <= row.frame <= shown[-1].frame
            writer.put(Solved(row.shot, snapshot, source, share, is_shown=is_shown))
            if is_shown:
                tally.add(row.triangle_count, snapshot.rmse)
    return tally.result(begun, (), [*device.notes, *drawing.notes, *_unsolved(look, options)])


def _unsolved(look: Look, options: SolveOptions) -> list[str]:
    """What is told of a timeline that changes meshes, where the track was solved without one."""
    timeline = look.score
    if not (isinstance(timeline, Timeline) and timeline.changes_meshes):
        return []
    if options.course != Course():
        return []
    return [
        f"{timeline.file} changes meshes, and the track was solved without: they stay as they are; "
        "solve with --timeline for that"
    ]


def _fitted(
    track: TrackReader,
    rows: list[FrameRow],
    options: SolveOptions,
    fitted: ColorModel,
    device: Device,
) -> Iterator[Snapshot]:
    """The snapshots of a track; where a look needs other colours, these are fitted again."""
    info = track.header.info
    if fitted == track.header.model:
        yield from track.snapshots(rows)
        return
    around = FrameRange(rows[0].frame, rows[-1].frame, track.header.frame_range.step)
    triangulator = triangulator_of(options, (info.width, info.height), device, fitted)
    wanted = {row.frame for row in rows}
    with open_decoder(options.source, around, read=options.read) as decoder:
        for frame in (frame for frame in decoder if frame.index in wanted):
            yield triangulator.fit(frame, track.snapshot(frame.index).mesh)
