"""Compare an output with its source, frame by frame; keeps only a few frames."""

from collections.abc import Iterable, Iterator
from contextlib import nullcontext
from pathlib import Path

from pipeline.compare.coherence import CoherenceMeter
from pipeline.compare.pairs import Matched, is_padded, matched, size_notes, size_of
from pipeline.compare.report import FrameFigures, Report, squared_error
from pipeline.compare.track_measures import TrackMeter
from pipeline.loop.shots import detected_shots
from pipeline.progress import Progress
from pipeline.track import TrackReader, refuse_track
from stages.flows.view import View
from stages.media import FrameRange, open_decoder


def measure(
    source: Path,
    output: Path,
    frame_range: FrameRange,
    track: Path | None = None,
    progress: Progress | None = None,
) -> Report:
    """Compare an output with its source.

    Frames are matched by their time from the first one that is compared; numbered stills carry
    no times and are matched by their order. Frames of different shots are not compared: a track
    tells where shots begin, without one hard cuts of the source are found.

    Args:
        source: What was converted.
        output: What came out; scaled to the source's size if it has another.
        frame_range: The frames of the source that the output shows.
        track: The mesh track that the output was drawn from, if its meshes are to be measured.
            If the range is the whole source, the track's own range is taken.
        progress: Told of every frame that is compared.

    Raises:
        MediaError: If one of the two cannot be read.
        TrackError: If the track cannot be read or is not that of the source or of its frames.
        TrimotionError: If their shapes or their frames do not match.
    """
    refuse_track(source)
    refuse_track(output)
    with nullcontext() if track is None else TrackReader(track) as reader:
        meter = None if reader is None else TrackMeter(reader, source)
        if reader is not None and frame_range.is_whole:
            frame_range = reader.header.frame_range
        return _measure(source, output, frame_range, meter, progress or Progress())


def _measure(
    source: Path,
    output: Path,
    frame_range: FrameRange,
    meter: TrackMeter | None,
    progress: Progress,
) -> Report:
    """Compare what was opened."""
    with open_decoder(source, frame_range) as original, open_decoder(output) as result:
        is_padded(original, result)  # refuses another shape before any frame is decoded
        if meter is not None:
            meter.check_size(original.info)
        found = _figures(matched(original, result), meter)
        frames = tuple(_told(found, result.info.frame_count, progress))
        notes = (*size_notes(original, result), *original.warnings, *result.warnings)
        meshes = [frame.mesh for frame in frames if frame.mesh is not None]
        figures = None if meter is None else meter.total(meshes)
        return Report(source, output, size_of(original), frames, figures, notes)


def _figures(pairs: Iterator[Matched], meter: TrackMeter | None) -> Iterator[FrameFigures]:
    """Figures of one frame after the other."""
    coherence = CoherenceMeter()
    for pair, shot in _with_shots(pairs, meter):
        number = pair.frame.index
        error = squared_error(pair.frame.pixels, pair.shown)
        found = coherence.add(pair, shot)
        mesh = None if meter is None else meter.add(number, coherence.motion)
        yield FrameFigures(number, pair.time, error, found, mesh)


def _told(
    frames: Iterable[FrameFigures], total: int | None, progress: Progress
) -> Iterator[FrameFigures]:
    """The same figures; each is told of."""
    for done, figures in enumerate(frames, start=1):
        progress.compared(done, total, figures.rmse)
        yield figures


def _with_shots(
    pairs: Iterator[Matched], meter: TrackMeter | None
) -> Iterator[tuple[Matched, int]]:
    """Pairs with the number of the frame with which their shot begins."""
    if meter is None:
        return detected_shots(pairs, lambda pair: pair.frame, lambda pair: View(pair.frame.pixels))
    return ((pair, meter.shot_of(pair.frame.index)) for pair in pairs)
