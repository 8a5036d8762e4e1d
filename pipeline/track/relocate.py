"""Another name for the source of a track: where it was solved it may have had one of its own."""

from contextlib import closing
from dataclasses import replace
from pathlib import Path

from pipeline.track.header import write_header
from pipeline.track.reader import TrackReader
from pipeline.track.schema import open_existing, writing


def relocate(track: Path, source: Path | str) -> None:
    """Say that the source lies elsewhere; what it is stays as it was found.

    Args:
        track: A track.
        source: Where its source lies, as the user calls it; a text if that is no file, see
            `SourceIdentity.is_file`.

    Raises:
        TrackError: If the track cannot be read.
        OutputError: If it cannot be written.
    """
    with TrackReader(track) as reader:
        header = reader.header
    place = source if isinstance(source, str) else str(source.absolute())
    moved = replace(
        header,
        options={**header.options, "source": str(source)},
        source=replace(header.source, path=place),
        info=replace(header.info, path=Path(source)),
    )
    with writing(track), closing(open_existing(track)) as connection:
        write_header(connection, moved)
