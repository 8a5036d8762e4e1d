"""`trimotion join`: checked, then done."""

from collections.abc import Sequence
from pathlib import Path

from pipeline.commands.pipes import shown_name
from pipeline.track import TrackReader, join
from pipeline.track.resume import check_track_name
from stages.media.writing.alone import alone
from stages.media.writing.place import check_folder, is_among
from warp_kernels.errors import OptionError, OutputError


def join_tracks(parts: Sequence[Path], output: Path, *, overwrite: bool, blend: int = 0) -> str:
    """Put tracks together.

    Args:
        parts: The tracks, in any order.
        output: The joined track.
        overwrite: Whether to replace an existing one.
        blend: Last frames over which parts that overlap fade into each other.

    Returns:
        What was done, in one line.

    Raises:
        OptionError: If the parts do not follow each other, or the output is one of them.
        OutputError: If the output exists or cannot be written.
        TrackError: If a part cannot be joined.
    """
    check_track_name(output)
    if blend < 0:
        raise OptionError(f"--blend {blend}: must be 0 or more")
    if is_among(output, parts):
        raise OptionError(f"{output}: is one of the tracks that are joined; choose another name")
    with alone(output):
        if output.exists() and not overwrite:
            raise OutputError(output, "exists already", "choose another name or --overwrite")
        check_folder(output)
        header = join(parts, output, blend=blend)
    seam = header.solve.seam
    with TrackReader(output) as track:
        rows = [row for row in track.rows if not seam.joints or row.frame <= seam.closes]
    joined = "1 track" if len(parts) == 1 else f"{len(parts)} tracks"
    which = f"frames {rows[0].frame} to {rows[-1].frame}, {len(rows)} in all"
    return f"{joined} joined, {which}: {shown_name(output)}"
