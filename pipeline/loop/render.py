"""A mesh track to an output: frames are drawn that were solved before."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from time import perf_counter

from pipeline.envelope import Solved, Standing
from pipeline.look.outputs import check_output_of, open_drawing
from pipeline.look.region_members import followed_shares
from pipeline.look.rows_around import rows_around
from pipeline.look.source_pictures import runs_of, source_pictures
from pipeline.loop.convert import SOLVED_BEHIND, triangulator_of
from pipeline.loop.result import Animated, Tally
from pipeline.loop.threads import Behind
from pipeline.options.course import Course
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.options.seam import Seam
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.stage_times import WAITING
from pipeline.timeline.timeline import Timeline
from pipeline.track import FrameRow, TrackReader
from stages.media import FrameRange, MediaInfo, open_decoder
from stages.media.writing.alone import alone
from stages.motion.morph import morphed
from stages.snapshot import Snapshot
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.errors import TrackError


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
    with alone(job.output.path):
        return drawn(job, track, info, progress)


def drawn(job: Job, track: TrackReader, info: MediaInfo, progress: Progress) -> Animated:
    """Draw a track, as `render` does, for one who sees to it that nobody else writes there."""
    begun = perf_counter()
    check_output_of(job, info)
    options, look = job.solve, job.look
    device = Device(job.run.device, job.run.threads, progress.kernels)
    shown = track.rows_in(options.frame_range)
    tally = Tally(job, progress, len(shown))
    times = tally.times
    drawing = open_drawing(job, info, device.beside(), times)

    def draw(solved: Solved) -> None:
        """Draw a frame in the other thread."""
        with times.spent("drawing"):
            drawing.draw(solved)

    with device, drawing, Behind(draw, SOLVED_BEHIND) as writer:
        leading = _leading(track, shown, options.seam)
        for standings in ([leading] if leading else []) + [{}]:
            seen = [row for row in track.rows if row.frame in standings] if standings else shown
            read = _solved(job, track, seen, standings, device)
            for solved in times.over("reading the track", read):
                with times.spent(f"{WAITING}the output"):
                    writer.put(solved)
                if solved.is_shown and not standings:
                    tally.solved(solved)
    return tally.result(begun, (), [*device.notes, *drawing.notes, *_unsolved(look, options)])


def _leading(track: TrackReader, shown: list[FrameRow], seam: Seam) -> dict[int, Standing]:
    """The frames that are blended into others to close a loop, with these."""
    found = {}
    clock = track.header.info.time_base
    for row in shown:
        partner = seam.partner_of(row.frame)
        if partner is not None:
            found[partner[0]] = Standing(row.frame, row.pts * clock, row.shot)
    return found


def _solved(
    job: Job,
    track: TrackReader,
    seen: list[FrameRow],
    standings: Mapping[int, Standing],
    device: Device,
) -> Iterator[Solved]:
    """Frames of a track, and those around them that they depend on, in one go.

    Args:
        job: What to do.
        track: Holds the snapshots.
        seen: The frames, in order.
        standings: For those that are blended into others, into which.
        device: Where kernels run.
    """
    options, look = job.solve, job.look
    rows = rows_around(track.rows, seen, options, look)
    fitted = _fitted(track, rows, options, job.fitted, device)
    sources = source_pictures(options, look, rows)
    shares = followed_shares(options, look, track, rows)
    for snapshot, row, source, share in zip(fitted, rows, sources, shares, strict=True):
        yield Solved(
            row.shot,
            _over_seam(snapshot, row, track, options.seam, standings),
            source,
            share,
            is_shown=seen[0].frame <= row.frame <= seen[-1].frame,
            begins=row is rows[0] and options.seam.over > 0,
            blended_into=standings.get(row.frame),
        )


def _over_seam(
    snapshot: Snapshot,
    row: FrameRow,
    track: TrackReader,
    seam: Seam,
    standings: Mapping[int, Standing],
) -> Snapshot:
    """A frame on its way to the one that it is blended with, so that both lie over each other."""
    if row.frame in standings:
        shown = standings[row.frame].frame
        partner = seam.partner_of(shown)
        assert partner is not None
        other, share = shown, 1.0 - partner[1]
    else:
        partner = None if standings else seam.partner_of(row.frame)
        if partner is None:
            return snapshot
        other, share = partner
    of_other = next((found for found in track.rows if found.frame == other), None)
    if of_other is None:
        raise TrackError(f"{track.path}: frame {other} is missing, into which {row.frame} fades")
    if of_other.shot != row.shot and not seam.joints:
        return snapshot  # numbers of different shots mean different vertices
    return morphed(snapshot, track.snapshot(other).mesh, share * share * (3.0 - 2.0 * share))


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
    triangulator = triangulator_of(options, (info.width, info.height), device, fitted)
    waiting = iter(rows)
    for run in runs_of(options, rows):
        around, wanted = FrameRange(run[0], run[-1], track.header.frame_range.step), set(run)
        with open_decoder(options.source, around, read=options.read) as decoder:
            for frame in (frame for frame in decoder if frame.index in wanted):
                row = next(waiting)
                seen = replace(frame, index=row.frame, pts=row.pts)
                yield triangulator.fit(seen, track.snapshot(row.frame).mesh)
