"""A source in one pass: the loop over time in which frames are solved.

A frame is drawn while the next one is solved and later ones are prepared, each in its own thread.
"""

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import closing, nullcontext
from time import perf_counter

from pipeline.edit_log.focus import focus_reached
from pipeline.envelope import MeshFrom, Prepared, Solved
from pipeline.look.drawing import Drawing
from pipeline.look.exporting import Exporting
from pipeline.look.outputs import check_output_of, open_drawing
from pipeline.look.source_pictures import source_pictures
from pipeline.loop.attention import Attention
from pipeline.loop.edit_frames import check_edits
from pipeline.loop.edited import EditedFrames
from pipeline.loop.motion import check_cuts, open_around
from pipeline.loop.prepare import prepared
from pipeline.loop.result import Animated, Tally
from pipeline.loop.seam import with_return
from pipeline.loop.solution import followed
from pipeline.loop.threads import Behind, ahead
from pipeline.options.job import Job
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.stage_times import WAITING, StageTimes
from pipeline.track import TrackReader, TrackWriter
from pipeline.track.resume import Past, open_track, past_of
from stages.masks.weight_maps import WeightMap
from stages.media import Decoder, MediaInfo
from stages.media.expected_frames import expected_frames
from stages.motion.painted_focus import NOTHING_PAINTED
from stages.triangulate import Triangulator
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device

DECODED_AHEAD = 3
"""Decoded frames that may wait."""
SOLVED_BEHIND = 3
"""Triangulated frames that may wait to be drawn and encoded."""


def convert(job: Job, fitted: ColorModel, progress: Progress) -> Animated:
    """Solve a source in one pass: to its track, to its output, or to both.

    Args:
        job: What to do; it follows no regions, which may come from frames that are solved later.
        fitted: The colour model of the snapshots.
        progress: Told of every finished frame.

    Raises:
        TrimotionError: As `animate` and `solve` do.
    """
    begun = perf_counter()
    options, track_path = job.solve, job.output.track
    draws = job.output.path is not None
    past = past_of(options, job.output, fitted)
    with open_around(options, None if past is None else past.reached) as decoder:
        info = decoder.info
        check_cuts(options.cuts, options.source, info)
        check_edits(options, info)
        if draws:
            check_output_of(job, info, options.triangulate.refine.most)
        device = Device(job.run.device, job.run.threads, progress.kernels)
        count = options.triangulate.refine.triangles
        step, factor = options.frame_range.step, options.course.focus
        attention = Attention(options.foci, info, step, count, factor)
        size = (info.width, info.height)
        maps = [WeightMap(str(m.file), size, options.frame_range, m.strength) for m in options.maps]
        tally = Tally(job, progress, _expected(options, info))
        # in this order all kernels of the job are compiled together
        drawing = open_drawing(job, info, device.beside(), tally.times) if draws else None
        triangulator = triangulator_of(options, size, device, fitted)
        restarts: list[str] = []
        refused: list[str] = []
        found = _opened(decoder, attention, maps, options, past, restarts, tally.times)
        with device, open_track(options, track_path, info, fitted, past) as track:
            writer = Behind(_Writer(track, drawing, tally.times), SOLVED_BEHIND)
            with drawing or nullcontext(), closing(found), writer:
                if past is not None:
                    _recall(job, tally, writer if draws else None)
                keeps = job.look.needs_source
                awaited = tally.times.over(f"{WAITING}frames", found)
                frames = solved_frames(awaited, triangulator, options, past, refused, keeps=keeps)
                for solved in tally.times.over("solving", frames):
                    _hand_on(solved, writer, tally)
            if track is not None:
                track.finish()
    made = [] if drawing is None else drawing.notes
    warnings = [*decoder.warnings, *refused, *(text for one in maps for text in one.warnings)]
    notes = [] if past is None else past.notes
    notes += restarts if track_path is not None else []
    told = [*device.notes, *decoder.notes, *notes, *attention.notes]
    told += [options.seam.note] if options.seam.over else []
    told += [note for one in maps for note in one.notes]
    return tally.result(begun, warnings, [*told, *made])


def _expected(options: SolveOptions, info: MediaInfo) -> int | None:
    """How many frames are solved, as far as can be told; a loop goes on beyond its end."""
    wanted = options.frame_range
    if options.seam.over and wanted.last is not None:
        return wanted.last - wanted.first + 1
    return expected_frames(wanted, info)


def _opened(
    decoder: Decoder,
    attention: Attention,
    maps: Sequence[WeightMap],
    options: SolveOptions,
    past: Past | None,
    notes: list[str],
    times: StageTimes,
) -> Generator[Prepared, None, None]:
    """Decode and prepare frames ahead of the solution."""
    reached = None if past is None else past.reached
    frames = times.over("decoding", with_return(decoder, options))
    found = prepared(frames, decoder.info, attention, maps, options, reached, notes)
    return ahead(times.over("cuts, focus and motion", found), DECODED_AHEAD)


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


def solved_frames(
    found: Iterable[Prepared],
    triangulator: Triangulator,
    options: SolveOptions,
    past: Past | None,
    refused: list[str] | None = None,
    *,
    keeps: bool = False,
) -> Iterator[Solved]:
    """Triangulate frame after frame, each from the mesh of the one before.

    Args:
        found: The frames, and the motion between them; one is taken for each that is given.
        triangulator: Made by `triangulator_of` for the options.
        options: Say how frames begin.
        past: What an earlier run left, or None.
        refused: Receives a sentence for each edit by hand that cannot be made.
        keeps: Whether what draws them needs their pictures.
    """
    snapshot = None if past is None else past.snapshot
    if options.edits is not None and options.edits.edits:
        focus = NOTHING_PAINTED if past is None else focus_reached(options.edits, past.track)
        edited = EditedFrames(triangulator, options, snapshot, focus=focus, keeps=keeps)
        yield from edited.solved(found)
        if refused is not None:
            refused += edited.refused
        return
    for ready in found:
        snapshot = followed(triangulator, options, ready, snapshot)
        if ready.mesh_from is not MeshFrom.TRACK:
            yield ready.solved(snapshot, keeps_picture=keeps)


def _recall(job: Job, tally: Tally, writer: Behind[Solved] | None) -> None:
    """Count what the track holds already, and draw it if that is wanted."""
    options, is_drawn = job.solve, writer is not None
    assert job.output.track is not None
    with TrackReader(job.output.track) as track:
        rows = track.rows_in(options.frame_range)
        sources = source_pictures(options, job.look, rows) if is_drawn else [None] * len(rows)
        for row, source in zip(rows, sources, strict=True):
            if writer is None:
                tally.recalled(row)
                continue
            solved = Solved(row.shot, track.snapshot(row.frame), source, is_stored=True)
            _hand_on(solved, writer, tally)


def _hand_on(solved: Solved, writer: Behind[Solved], tally: Tally) -> None:
    """Let a frame be stored and drawn, and count it."""
    with tally.times.spent(f"{WAITING}the output"):
        writer.put(solved)
    tally.solved(solved)


class _Writer:
    """Stores a solved frame, and draws it."""

    def __init__(
        self, track: TrackWriter | None, drawing: Drawing | Exporting | None, times: StageTimes
    ) -> None:
        self._track = track
        self._drawing = drawing
        self._times = times

    def __call__(self, solved: Solved) -> None:
        if self._track is not None and not solved.is_stored:
            with self._times.spent("writing the track"):
                self._track.write(solved.snapshot, solved.shot, more=solved.has_more)
        if self._drawing is not None:
            with self._times.spent("drawing"):
                self._drawing.draw(solved)
