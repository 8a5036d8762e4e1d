"""A mesh track as a collection of triangulations."""

import dataclasses
import operator
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pipeline.library.given import file_name
from pipeline.library.keywords import Name
from pipeline.library.track_options import solved_with
from pipeline.library.triangulation import Origin, Triangulation
from pipeline.library.wording import worded
from pipeline.track import FrameRow, TrackReader
from warp_kernels.errors import OptionError, TrackError


class Track:
    """An opened mesh track; a context manager.

    `track[57]` is what frame 57 of the source became, whatever frame the track begins with;
    `57 in track` says whether it is there, and iterating gives all of them in order. A frame is
    read when it is asked for.
    """

    def __init__(self, path: Path) -> None:
        """Open a track; see `open_track`."""
        self._reader = TrackReader(path)
        self._is_closed = False
        self._rows = {row.frame: row for row in self._reader.rows}

    @property
    def path(self) -> Path:
        """The file."""
        return self._reader.path

    @property
    def frames(self) -> tuple[int, ...]:
        """Numbers of its frames in the source, in order."""
        return tuple(self._rows)

    @property
    def shots(self) -> tuple[int, ...]:
        """Numbers of the frames with which shots begin, in order."""
        return self._reader.shots

    @property
    def source(self) -> Path | str:
        """Where the source lay when it was solved; a text if that was no file but an address."""
        found = self._reader.header.source
        return Path(found.path) if found.is_file else found.path

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the source [px]."""
        info = self._reader.header.info
        return info.width, info.height

    @property
    def finished(self) -> bool:
        """Whether all frames that were asked for are there."""
        return self._reader.header.finished

    @property
    def program(self) -> str:
        """Version of trimotion that solved it."""
        return self._reader.header.program

    @property
    def options(self) -> Mapping[str, Any]:
        """What it was solved with, as keywords of `solve`; a list of cuts is the list itself."""
        return solved_with(self._reader.header)

    @worded()
    def __getitem__(self, frame: int) -> Triangulation:
        """What a frame of the source became.

        Raises:
            TrackError: If the track does not hold it, is damaged or closed.
            OptionError: If it is no number.
        """
        try:
            number = operator.index(frame)
        except TypeError:
            raise OptionError(f"track[{frame!r}]: give the number of one frame") from None
        if self._is_closed:
            raise TrackError(f"{self.path}: the track is closed; open it again")
        if number not in self._rows:
            raise TrackError(f"{self.path}: holds no frame {number}; {self._held()}")
        return self._told(self._rows[number])

    def __len__(self) -> int:
        return len(self._rows)

    def __contains__(self, frame: object) -> bool:
        return frame in self._rows

    def __iter__(self) -> Iterator[Triangulation]:
        return (self[frame] for frame in self.frames)

    def close(self) -> None:
        """Release the file."""
        self._is_closed = True
        self._reader.close()

    def __enter__(self) -> "Track":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Track {self.path}: {len(self)} frames, {len(self.shots)} shots>"

    def _told(self, row: FrameRow) -> Triangulation:
        header = self._reader.header
        time = row.pts * header.info.time_base - header.info.start_time
        origin = Origin(color=str(header.options["triangulate"]["color"]), shot=row.shot)
        origin = dataclasses.replace(origin, time=float(time))
        return Triangulation(self._reader.snapshot(row.frame), origin)

    def _held(self) -> str:
        """Which frames there are."""
        if not self._rows:
            return "solve it again, it has none"
        return f"it has {self.frames[0]} to {self.frames[-1]}, see track.frames"


@worded()
def open_track(path: Name) -> Track:
    """Open a mesh track, to look at its triangles.

    Args:
        path: A file that `solve` wrote.

    Raises:
        TrackError: If it is none, or damaged.
    """
    return Track(Path(file_name("path", path)))
