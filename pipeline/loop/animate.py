"""Video in, triangulated video out: the only loops over time.

Solving turns frames into snapshots, drawing turns snapshots into frames. `animate` does both at
once, `solve` the first and `render` the second, with a mesh track in between.
"""

from collections import deque
from collections.abc import Generator, Iterable, Iterator
from contextlib import closing, nullcontext
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from pipeline.job import Job
from pipeline.look.drawing import Drawing, check_drawing
from pipeline.look.drawn_frame import Take
from pipeline.look.region_members import followed_shares
from pipeline.look.rows_around import rows_around
from pipeline.look.source_pictures import source_pictures
from pipeline.loop.attention import Attention
from pipeline.loop.expected_frames import expected_frames
from pipeline.loop.motion import Step, check_cuts, open_around, steps
from pipeline.loop.shots import with_shots
from pipeline.loop.threads import Behind, ahead
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import FrameRow, TrackReader, TrackWriter
from pipeline.track.resume import Past, Reached, open_track, past_of
from stages.frame import Frame
from stages.masks.weight_maps import WeightMap
from stages.media import Decoder, FrameRange, MediaInfo, open_decoder
from stages.motion.advect import advect
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from warp_kernels.device.device import Device
from warp_kernels.energy.color_model import ColorModel
from warp_kernels.errors import OptionError

DECODED_AHEAD = 3
"""Decoded frames that may wait."""
SOLVED_BEHIND = 3
"""Triangulated frames that may wait to be drawn and encoded."""


@dataclass(frozen=True)
class Animated:
    """What a finished job came to."""

    frames: int
    """Frames written."""
    seconds: float
    """Wall time, from the first frame's decoding to the finished file [s]."""
    mean_rmse: float
    """Mean over the frames of the root mean square error [code values]."""
    warnings: tuple[str, ...]
    """Damage that was met, one sentence each."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""


@dataclass(frozen=True, eq=False, slots=True)
class Solved:
    """What a frame became."""

    snapshot: Snapshot
    """Its triangles and colours."""
    shot: int
    """Number of the frame with which its shot begins."""
    source: np.ndarray | None = None
    """Its picture [code values], [H, W, 3]; None unless a look needs it."""
    is_stored: bool = False
    """Whether the track holds it already."""


def animate(job: Job, progress: Progress) -> Animated:
    """Convert a source at once; a job that follows regions needs `animate_in_parts`.

    Nothing is written under the output's name unless the whole job succeeds; a track that the
    job writes beside it keeps every frame that was solved.

    Args:
        job: What to do.
        progress: Told of every finished frame.

    Raises:
        MediaError: If the source or the map of weights cannot be read.
        OptionError: If an option does not fit the source, or regions are to be followed.
        OutputError: If the output cannot be written.
        TrackError: If the track to go on with cannot be.
    """
    if job.look.followed:
        region = job.look.followed[0]
        raise OptionError(
            f"--region {region.mask}@{region.frames[0]}: a frame is drawn here before later ones "
            "are solved, and this region may come from these; use animate_in_parts"
        )
    return _convert(job, job.fitted, progress)


def solve(
    options: SolveOptions,
    output: Output,
    run: Run,
    progress: Progress,
    fitted: ColorModel | None = None,
) -> Animated:
    """Solve a source and write the mesh track alone.

    Args:
        options: What decides the meshes.
        output: Names the track.
        run: What the work may use.
        progress: Told of every finished frame.
        fitted: The colour model of the snapshots, if a look needs more than the optimised one.

    Raises:
        MediaError: If the source cannot be read.
        OptionError: If an option does not fit the source.
        OutputError: If the track cannot be written.
        TrackError: If the track to go on with cannot be.
    """
    job = Job(options, output=replace(output, path=None), run=run)
    return _convert(job, fitted or options.model, progress)


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
    check_drawing(job, info)
    options, look = job.solve, job.look
    device = Device(job.run.device, job.run.threads, progress.kernels)
    shown = track.rows_in(options.frame_range)
    rows = rows_around(track.rows, shown, options, look)
    tally = _Tally(progress, len(shown))
    drawing = Drawing(job, info, device)
    with device, drawing, Behind(drawing.draw, SOLVED_BEHIND) as writer:
        fitted = _fitted(track, rows, options, job.fitted, device)
        sources = source_pictures(options, look, rows)
        shares = followed_shares(options, look, track, rows)
        for snapshot, row, source, share in zip(fitted, rows, sources, shares, strict=True):
            is_shown = shown[0].frame <= row.frame <= shown[-1].frame
            writer.put(Take(snapshot, row.shot, is_shown, source, share))
            if is_shown:
                tally.add(row.triangle_count, snapshot.rmse)
    return tally.result(begun, (), [*device.notes, *drawing.notes])


def _convert(job: Job, fitted: ColorModel, progress: Progress) -> Animated:
    """Solve a job, and draw it at once if that is wanted."""
    begun = perf_counter()
    options, track_path = job.solve, job.output.track
    draws = job.output.path is not None
    past = past_of(options, job.output, fitted)
    with open_around(options, None if past is None else past.reached) as decoder:
        info = decoder.info
        check_cuts(options.cuts, options.source, info)
        if draws:
            check_drawing(job, info)
        device = Device(job.run.device, job.run.threads, progress.kernels)
        count = options.triangulate.refine.triangles
        attention = Attention(options.foci, info, options.frame_range.step, count)
        size = (info.width, info.height)
        maps = [WeightMap(str(m.file), size, options.frame_range, m.strength) for m in options.maps]
        # in this order all kernels of the job are compiled together
        drawing = Drawing(job, info, device) if draws else None
        triangulator = triangulator_of(options, size, device, fitted)
        tally = _Tally(progress, expected_frames(options.frame_range, info))
        restarts: list[str] = []
        found = _open_steps(decoder, attention, maps, options, past, restarts)
        with device, open_track(options, track_path, info, fitted, past) as track:
            writer = Behind(_Writer(track, drawing), SOLVED_BEHIND)
            with drawing or nullcontext(), closing(found), writer:
                if past is not None:
                    _recall(job, tally, writer if draws else None)
                keeps = job.look.needs_source
                for solved in solved_frames(found, triangulator, options, past, keeps=keeps):
                    writer.put(solved)
                    tally.add(solved.snapshot.mesh.triangle_count, solved.snapshot.rmse)
            if track is not None:
                track.finish()
    made = [] if drawing is None else drawing.notes
    warnings = [*decoder.warnings, *(text for one in maps for text in one.warnings)]
    notes = [] if past is None else past.notes
    notes += restarts if track_path is not None else []
    told = [*device.notes, *decoder.notes, *notes, *attention.notes]
    told += [note for one in maps for note in one.notes]
    return tally.result(begun, warnings, [*told, *made])


def triangulator_of(
    options: SolveOptions, size: tuple[int, int], device: Device, fitted: ColorModel
) -> Triangulator:
    """What makes snapshots of a source for the looks that will be drawn.

    Args:
        options: Say how pictures become triangles.
        size: Width and height of the source, upright [px].
        device: Where kernels run.
        fitted: The colour model of the snapshots.
    """
    return Triangulator(device, size, options.triangulate, fitted)


def _open_steps(
    decoder: Decoder,
    attention: Attention,
    maps: Iterable[WeightMap],
    options: SolveOptions,
    past: Past | None,
    notes: list[str],
) -> Generator[Step, None, None]:
    """Decode and prepare frames ahead of the solution."""
    reached = None if past is None else past.reached
    found = prepared(decoder, decoder.info, attention, maps, options, reached, notes)
    return ahead(found, DECODED_AHEAD)


def prepared(
    frames: Iterable[Frame],
    info: MediaInfo,
    attention: Attention,
    maps: Iterable[WeightMap],
    options: SolveOptions,
    reached: Reached | None,
    notes: list[str],
) -> Iterator[Step]:
    """Find cuts, weigh and estimate motion: all that frames go through before they are solved.

    Args:
        frames: The frames of the range and around it.
        info: Their source.
        attention: Weighs them by what `--focus` names.
        maps: Weigh them by pictures.
        options: Say what is wanted.
        reached: Where an earlier run ended, or None.
        notes: Receives what the user of a track should know, one sentence each.
    """
    shot_frames = attention.beside(with_shots(frames, options.cuts))
    found = steps(shot_frames, info, options, reached, notes)
    for weights in maps:
        found = _weighed(found, weights)
    return found


def _weighed(found: Iterable[Step], weights: WeightMap) -> Iterator[Step]:
    """Steps whose frames have their weights; frames around the range need none."""
    waiting: deque[Step] = deque()

    def frames() -> Iterator[Frame]:
        """The frames of the steps, which wait for them."""
        for step in found:
            waiting.append(step)
            yield step.frame

    for frame in weights.beside(frames()):
        yield replace(waiting.popleft(), frame=frame)


def solved_frames(
    found: Iterable[Step],
    triangulator: Triangulator,
    options: SolveOptions,
    past: Past | None,
    *,
    keeps: bool = False,
) -> Iterator[Solved]:
    """Triangulate frame after frame, each from the mesh of the one before.

    A picture that comes again, as in what is drawn for every other frame, keeps its mesh.

    Args:
        found: The frames, and the motion between them; one is taken for each that is given.
        triangulator: Made by `triangulator_of` for the options.
        options: Say how frames begin.
        past: What an earlier run left, or None.
        keeps: Whether what draws them needs their pictures.
    """
    snapshot = None if past is None else past.snapshot
    for step in found:
        if snapshot is not None and step.before is not None:
            triangulator.recall(step.before, snapshot)
        if snapshot is None or step.passage is None:
            rng = np.random.default_rng([options.seed, step.frame.index])
            snapshot = triangulator.first(step.frame, options.layout, rng)
        elif step.repeats and not options.maps:
            snapshot = snapshot.again(step.frame)
        else:
            carried = advect(snapshot.mesh, step.passage)
            snapshot = triangulator.next(step.frame, carried, snapshot)
        yield Solved(snapshot, step.shot, step.frame.pixels if keeps else None)


def _recall(job: Job, tally: "_Tally", writer: Behind[Solved] | None) -> None:
    """Count what the track holds already, and draw it if that is wanted."""
    options, is_drawn = job.solve, writer is not None
    assert job.output.track is not None
    with TrackReader(job.output.track) as track:
        rows = track.rows_in(options.frame_range)
        sources = source_pictures(options, job.look, rows) if is_drawn else [None] * len(rows)
        for row, source in zip(rows, sources, strict=True):
            if writer is not None:
                writer.put(Solved(track.snapshot(row.frame), row.shot, source, is_stored=True))
            tally.add(row.triangle_count, row.rmse, is_told=is_drawn)


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


class _Tally:
    """Counts finished frames and tells of them."""

    def __init__(self, progress: Progress, total: int | None) -> None:
        self._progress = progress
        self._total = total
        self._errors: list[float] = []
        self._told = 0

    def add(self, triangles: int, rmse: float, *, is_told: bool = True) -> None:
        """Count a frame; what an earlier run told of is not told again."""
        self._errors.append(rmse)
        if is_told:
            self._told += 1
            self._progress.frame(len(self._errors), self._total, triangles, rmse)

    def result(self, begun: float, warnings: Iterable[str], notes: Iterable[str]) -> Animated:
        """What the job came to."""
        return Animated(
            frames=self._told,
            seconds=perf_counter() - begun,
            mean_rmse=float(np.mean(self._errors)),
            warnings=tuple(warnings),
            notes=tuple(notes),
        )


class _Writer:
    """Stores a solved frame, and draws it."""

    def __init__(self, track: TrackWriter | None, drawing: Drawing | None) -> None:
        self._track = track
        self._drawing = drawing

    def __call__(self, solved: Solved) -> None:
        if self._track is not None and not solved.is_stored:
            self._track.write(solved.snapshot, solved.shot)
        if self._drawing is not None:
            self._drawing.draw(Take(solved.snapshot, solved.shot, source=solved.source))
