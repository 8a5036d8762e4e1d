"""What drawing a track needs: the job, and the source as far as it can still be read."""

from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.edit_log.journal import EditJournal
from pipeline.edit_log.painted_regions import PaintedRegions, painted_regions
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.track import TrackReader
from stages.exchange import is_exchange
from stages.media import FrameRange, MediaInfo, input_pattern
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import MediaError, OptionError, TrackError


@dataclass(frozen=True)
class RenderJob:
    """How a track is drawn."""

    job: Job
    """What was asked for, with the options that the track was made with."""
    info: MediaInfo
    """The source; without sound if it cannot be read any more."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""
    warnings: tuple[str, ...]
    """What the track lacks, one sentence each."""


def render_job(
    track: TrackReader,
    wanted: FrameRange,
    look: Look,
    output: Output,
    run: Run,
    source: Path | None,
) -> RenderJob:
    """Combine a look with a track; what edits in force in it give a style is drawn over the look.

    Args:
        track: The track.
        wanted: The frames that are asked for.
        look: How they are drawn.
        output: Where and how they are written.
        run: What the work may use.
        source: Where the source is now, or None for where it was.

    Raises:
        OptionError: If the track holds no frame of the range.
        MediaError: If the source is named, or needed, and not there.
        TrackError: If the source is named, or needed, and another one.
    """
    header = track.header
    options = replace(header.solve, frame_range=_range(wanted, track))
    last = track.rows[-1].frame
    drawn = _drawn(track)
    is_shape = output.path is not None and is_exchange(output.path)
    look = look if is_shape else drawn.over(look)
    found, problem = _find(source, track, _needs(look, options.model, header.model))
    info = header.info
    notes = []
    if is_shape and drawn.regions:
        notes.append(f"{output.path}: styles of regions, which edits gave, are left out")
    if wanted.last is not None and wanted.last > last:
        notes.append(f"frames {wanted}: the track ends with frame {last}")
    if found is None:
        if info.audio_codec is not None and output.encode.audio:
            notes.append(f"{problem}: the sound is left out; to have it {header.source.remedy}")
        info = replace(info, audio_codec=None, audio_channels=None, audio_rate=None)
    else:
        options, info = replace(options, source=found), replace(info, path=found)
    warnings = drawn.refused
    if not header.finished:
        warnings = (f"{track.path} is unfinished: its frames end with {last}", *warnings)
    job = Job(options, look, output, run)
    return RenderJob(job, info, tuple(notes), warnings)


def _drawn(track: TrackReader) -> PaintedRegions:
    """What edits that are in force in a track give a style."""
    if track.header.solve.independent:
        return PaintedRegions()
    with EditJournal(track.path) as journal:
        log = journal.log
    return painted_regions(log, {row.frame for row in track.rows})


def _range(wanted: FrameRange, track: TrackReader) -> FrameRange:
    """The frames that are drawn: those asked for, else all that the track is meant to hold."""
    if not track.rows:
        raise TrackError(f"{track.path}: holds no frame yet; solve it again")
    seam = track.header.solve.seam
    if wanted.is_whole:
        wanted = track.header.frame_range
        if seam.over:  # what leads over the seam is not shown by itself
            wanted = FrameRange(seam.opens, seam.closes)
        if not track.header.finished:
            wanted = replace(wanted, last=track.rows[-1].frame)
    if not track.rows_in(wanted):
        raise OptionError(
            f"frames {wanted} of {track.path}: there are none; the track has frames "
            f"{track.rows[0].frame} to {track.rows[-1].frame}"
        )
    return wanted


def _needs(look: Look, optimised: ColorModel, stored: ColorModel) -> str:
    """What a look finds in the source alone; nothing if the track is enough."""
    if look.needs_source:
        return "a look that shows the source"
    if look.fitted(optimised) != stored:
        return f"a look that needs colours other than the track's {stored.name} ones"
    return ""


def _find(named: Path | None, track: TrackReader, needed: str) -> tuple[Path | None, str]:
    """The source, or None and why it cannot be used.

    Args:
        named: Where the user says that it is, or None.
        track: The track.
        needed: What needs it; nothing if it can be done without.
    """
    header = track.header
    if named is not None:
        header.source.check(named)
        return named, ""
    place, remedy = header.source.path, header.source.remedy
    path = Path(place)
    try:
        if not header.source.is_file:
            raise MediaError(place, "the source was no file", remedy)
        if not _is_there(path):
            raise MediaError(place, "the source is not there", remedy)
        header.source.check(path)
    except (MediaError, OptionError, TrackError) as error:
        reason = str(error).split(";")[0]  # its remedy is the same
        if needed:
            reason = reason.removeprefix(f"{place}: ")
            raise MediaError(place, f"{needed} needs the source ({reason})", remedy) from error
        return None, reason
    return path, ""


def _is_there(path: Path) -> bool:
    """Whether there is a file of a name that somebody else chose, or stills."""
    try:
        return path.is_file() or input_pattern(path) is not None
    except OSError:  # a name that is too long
        return False
