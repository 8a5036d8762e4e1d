"""What a track says about how it was made."""

import json
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pipeline.job import Job
from pipeline.plain_values import from_plain, to_plain
from pipeline.shots import read_cuts
from pipeline.track.identity import SourceIdentity, identity_of
from pipeline.version import library_versions, program_version
from stages.focus.none import NoFocus
from stages.media import FrameRange, MediaInfo
from warp_kernels.color_model import COLOR_MODELS, ColorModel
from warp_kernels.errors import TrackError


@dataclass(frozen=True)
class Header:
    """All that is needed to prove how a track was made."""

    program: str
    """Version of the program that began it."""
    libraries: Mapping[str, str]
    """Versions of the libraries on which the bits depend."""
    options: Mapping[str, Any]
    """The whole job as plain values; a list of cuts is stored itself, not its name."""
    source: SourceIdentity
    """The source's identity."""
    info: MediaInfo
    """The source's properties."""
    model: ColorModel
    """The colour model of the snapshots."""
    finished: bool = False
    """Whether the range of the job was solved to its end."""

    @classmethod
    def of(cls, job: Job, info: MediaInfo, model: ColorModel) -> "Header":
        """The header of a job that begins.

        Args:
            job: The job.
            info: Its source.
            model: The colour model of its snapshots.
        """
        options = {**to_plain(job), "cuts": plain_cuts(job.cuts)}
        return cls(
            program=program_version(),
            libraries=library_versions(),
            options=options,
            source=identity_of(job.source),
            info=info,
            model=model,
        )

    @property
    def other_versions(self) -> list[str]:
        """What has another version here than where the track was begun."""
        now = {"trimotion": program_version(), **library_versions()}
        then = {"trimotion": self.program, **self.libraries}
        return [
            f"{name} {now.get(name)} instead of {version}"
            for name, version in then.items()
            if now.get(name) != version
        ]

    @cached_property
    def frame_range(self) -> FrameRange:
        """The frames that were asked for."""
        frame_range: FrameRange = from_plain(FrameRange, self.options["frame_range"])
        return frame_range

    @cached_property
    def job(self) -> Job:
        """The job again, without its list of cuts."""
        listed = isinstance(self.options["cuts"], list)
        job: Job = from_plain(Job, {**self.options, "cuts": "none"} if listed else self.options)
        return job

    def with_range(self, frame_range: FrameRange) -> "Header":
        """The header of the same job over other frames."""
        return replace(self, options={**self.options, "frame_range": to_plain(frame_range)})


def plain_cuts(cuts: str) -> str | list[int]:
    """What is stored of `--cuts`: the word, or the list itself.

    Args:
        cuts: `auto`, `none` or the name of a list.

    Raises:
        MediaError: If the list cannot be read.
    """
    return cuts if cuts in ("auto", "none") else sorted(read_cuts(Path(cuts)))


def write_header(connection: sqlite3.Connection, header: Header) -> None:
    """Store a header in place of what stands there."""
    rows = {
        "program": header.program,
        "libraries": dict(header.libraries),
        "options": header.options,
        "source": to_plain(header.source),
        "info": to_plain(header.info),
        "model": header.model.name,
        "finished": header.finished,
    }
    connection.executemany(
        "INSERT OR REPLACE INTO header VALUES (?, ?)",
        [(key, json.dumps(value)) for key, value in rows.items()],
    )


def read_header(path: Path, connection: sqlite3.Connection) -> Header:
    """Read a header.

    Raises:
        TrackError: If it is incomplete.
    """
    stored = dict(connection.execute("SELECT key, value FROM header").fetchall())
    try:
        rows = {key: json.loads(value) for key, value in stored.items()}
        rows["options"].setdefault("focus", [to_plain(NoFocus())])  # older tracks knew none
        return Header(
            program=rows["program"],
            libraries=rows["libraries"],
            options=rows["options"],
            source=from_plain(SourceIdentity, rows["source"]),
            info=from_plain(MediaInfo, rows["info"]),
            model=COLOR_MODELS[rows["model"]],
            finished=rows["finished"],
        )
    except (KeyError, TypeError, ValueError) as error:
        raise TrackError(
            f"{path}: the track's header is damaged ({error}); take a copy of it, or solve again"
        ) from error
