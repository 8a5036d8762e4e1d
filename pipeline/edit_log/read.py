"""A log of edits from whatever holds one: a file of JSON lines, or a track."""

from pathlib import Path

from pipeline.edit_log.journal import EditJournal
from pipeline.edit_log.json_lines import read_lines
from pipeline.options.edit_log import EditLog
from pipeline.track import is_track


def read_log(path: Path) -> EditLog:
    """Read a log; of a track, the edits that are in force.

    Args:
        path: A file of JSON lines, or a track.

    Raises:
        MediaError: If it cannot be read, or holds something else.
        TrackError: If it is a damaged track.
    """
    if is_track(path):
        with EditJournal(path) as journal:
            return journal.log
    return read_lines(path)
