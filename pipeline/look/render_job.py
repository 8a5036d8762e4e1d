"""What drawing a track needs: the job, and the source as far as it can still be read."""

from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.job import Job
from pipeline.track import TrackReader
from stages.media import FrameRange, MediaInfo, input_pattern
from warp_kernels.errors import MediaError, OptionError, TrackError


@dataclass(frozen=True)
class RenderJob:
    """How a track is drawn."""

    job: Job
    """The look that is wanted, with the options that the track was made with."""
    info: MediaInfo
    """The source; without sound if it cannot be read any more."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""
    warnings: tuple[str, ...]
    """What the track lacks, one sentence each."""


def render_job(look: Job, track: TrackReader, source: Path | None) -> RenderJob:
    """Combine a look with a track.

    Args:
        look: Says how the output looks and how it is written; the rest is ignored.
        track: The track.
        source: Where the source is now, or None for where it was.

    Raises:
        OptionError: If the track holds no frame of the range.
        MediaError: If the source is named, or needed, and not there.
        TrackError: If the source is named, or needed, and another one.
    """
    header = track.header
    job = replace(header.job, output=look.output, encode=look.encode, styles=look.styles)
    job = replace(job, regions=look.regions)
    job = replace(job, output_size=None, scale=None, track=None, resume=False, jobs=1)
    job = replace(job, output_size=look.output_size, scale=look.scale)
    job = replace(job, blend=look.blend, smooth=look.smooth)
    job = replace(job, device=look.device, threads=look.threads)
    job = replace(job, frame_range=_range(look.frame_range, track))
    last = track.rows[-1].frame
    found, problem = _find(source, track, _needs(job, track))
    info = header.info
    notes = []
    if look.frame_range.last is not None and look.frame_range.last > last:
        notes.append(f"frames {look.frame_range}: the track ends with frame {last}")
    if found is None:
        if info.audio_codec is not None and job.encode.audio:
            notes.append(f"{problem}: the sound is left out; --source says where it is now")
        info = replace(info, audio_codec=None, audio_channels=None, audio_rate=None)
    else:
        job, info = replace(job, source=found), replace(info, path=found)
    warnings: tuple[str, ...] = ()
    if not header.finished:
        warnings = (f"{track.path} is unfinished: its frames end with {last}",)
    return RenderJob(job, info, tuple(notes), warnings)


def _range(wanted: FrameRange, track: TrackReader) -> FrameRange:
    """The frames that are drawn: those asked for, else all that the track is meant to hold."""
    if not track.rows:
        raise TrackError(f"{track.path}: holds no frame yet; solve it again")
    if wanted.is_whole:
        wanted = track.header.frame_range
        if not track.header.finished:
            wanted = replace(wanted, last=track.rows[-1].frame)
    if not track.rows_in(wanted):
        raise OptionError(
            f"frames {wanted} of {track.path}: there are none; the track has frames "
            f"{track.rows[0].frame} to {track.rows[-1].frame}"
        )
    return wanted


def _needs(job: Job, track: TrackReader) -> str:
    """What a look finds in the source alone; nothing if the track is enough."""
    if job.needs_source:
        return "a look that shows the source"
    model = track.header.model
    if job.fitted != model:
        return f"a look that needs colours other than the track's {model.name} ones"
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
    path = Path(header.source.path)
    try:
        if not _is_there(path):
            raise MediaError(path, "the source is not there", "say with --source where it is")
        header.source.check(path)
    except (MediaError, OptionError, TrackError) as error:
        if needed:
            reason = str(error).removeprefix(f"{path}: ")
            raise MediaError(
                path,
                f"{needed} needs the source ({reason})",
                "say with --source where it is",
            ) from error
        return None, str(error).split(";")[0]
    return path, ""


def _is_there(path: Path) -> bool:
    """Whether there is a file of a name that somebody else chose, or stills."""
    try:
        return path.is_file() or input_pattern(path) is not None
    except OSError:  # a name that is too long
        return False
