"""What a track says about how it was made."""

import json
import reprlib
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pipeline.options.solve_options import SolveOptions
from pipeline.track.cuts import read_cuts
from pipeline.track.earlier import up_to_date
from pipeline.track.identity import SourceIdentity, identity_of
from pipeline.track.nouns import noun_for
from pipeline.track.plain_values import UnknownNameError, from_plain, to_plain
from pipeline.version import library_versions, program_version
from stages.media import FrameRange, MediaInfo
from warp_kernels.color_model import COLOR_MODELS, ColorModel
from warp_kernels.errors import OptionError, TrackError
from warp_kernels.limits import MAX_SIDE

KEYS = frozenset({"program", "libraries", "options", "source", "info", "model", "finished"})
"""What a header holds."""
MOST_VALUES = 250_000
"""Values of a field, more than any list of cuts has: a text of a few megabytes could become
gigabytes of small lists."""
MOST_UNITS = 1 << 31
"""FFmpeg's fractions are of smaller numbers."""


@dataclass(frozen=True)
class Header:
    """All that is needed to prove how a track was made."""

    program: str
    """Version of the program that began it."""
    libraries: Mapping[str, str]
    """Versions of the libraries on which the bits depend."""
    options: Mapping[str, Any]
    """`SolveOptions` as plain values; a list of cuts is stored itself, not its name."""
    source: SourceIdentity
    """The source's identity."""
    info: MediaInfo
    """The source's properties."""
    model: ColorModel
    """The colour model of the snapshots."""
    finished: bool = False
    """Whether the range of the job was solved to its end."""

    @classmethod
    def of(cls, options: SolveOptions, info: MediaInfo, model: ColorModel) -> "Header":
        """The header of a track that begins.

        Args:
            options: What decides its meshes.
            info: Its source.
            model: The colour model of its snapshots.
        """
        return cls(
            program=program_version(),
            libraries=library_versions(),
            options=plain_options(options),
            source=identity_of(options.source),
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
    def solve(self) -> SolveOptions:
        """The options again, without a list of cuts and without pictures, which draw nothing."""
        return self._solve(arrays=False)

    @property
    def whole_solve(self) -> SolveOptions:
        """The same with pictures, by which a shot of the track can be solved again."""
        return self._solve(arrays=True)

    def _solve(self, *, arrays: bool) -> SolveOptions:
        listed = isinstance(self.options["cuts"], list)
        options = {**self.options, "cuts": "none"} if listed else self.options
        solve: SolveOptions = from_plain(SolveOptions, options, arrays=arrays)
        return solve

    def with_range(self, frame_range: FrameRange) -> "Header":
        """The header of the same solution over other frames."""
        return replace(self, options={**self.options, "frame_range": to_plain(frame_range)})


def plain_options(options: SolveOptions) -> dict[str, Any]:
    """What is stored of options; of a list of cuts the list itself.

    Args:
        options: What decides the meshes.

    Raises:
        MediaError: If the list cannot be read.
    """
    cuts = options.cuts
    listed = cuts if cuts in ("auto", "none") else sorted(read_cuts(Path(cuts)))
    return {**to_plain(options), "cuts": listed}


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
    """Read a header, all of it: what it says is used without a second look.

    Raises:
        TrackError: If it is incomplete, or says what cannot be.
    """
    found = connection.execute("SELECT key, value FROM header LIMIT 99").fetchall()
    try:
        rows = {key: _loaded(value) for key, value in found}
        unknown = rows.keys() - KEYS
        if unknown:
            raise UnknownNameError(f"the fact {reprlib.repr(min(map(str, unknown)))}")
        header = Header(
            program=_text(rows["program"]),
            libraries={_text(k): _text(v) for k, v in _table(rows["libraries"]).items()},
            options=up_to_date(_table(rows["options"])),
            source=from_plain(SourceIdentity, rows["source"]),
            info=from_plain(MediaInfo, rows["info"]),
            model=_model(_text(rows["model"])),
            finished=rows["finished"],
        )
        _check_info(header.info)
        _check_options(header)
    except UnknownNameError as error:
        raise TrackError(
            f"{path}: the track's header names {error}, which this program does not know; use the "
            "version that made it, or solve again"
        ) from error
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError, OptionError) as error:
        reason = f"{error} is missing" if isinstance(error, KeyError) else error
        raise TrackError(
            f"{path}: the track's header is damaged ({reason}); take a copy of it, or solve again"
        ) from error
    return header


def _loaded(text: Any) -> Any:
    """A field of the header."""
    text = _text(text)
    if text.count(",") + text.count("[") + text.count("{") > MOST_VALUES:
        raise ValueError(f"a field of more than {MOST_VALUES} values")
    return json.loads(text, parse_constant=_refused)


def _refused(name: str) -> None:
    raise ValueError(f"{name} is no number")


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{noun_for(value)} instead of a text")
    return value


def _table(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"{noun_for(value)} instead of a table")
    return value


def _model(name: str) -> ColorModel:
    if name not in COLOR_MODELS:
        raise ValueError(f"colours {reprlib.repr(name)}")
    return COLOR_MODELS[name]


def _check_info(info: MediaInfo) -> None:
    """Refuse what no source is like."""
    if not 1 <= min(info.width, info.height) <= max(info.width, info.height) <= MAX_SIDE:
        raise ValueError(f"a picture of {info.width}x{info.height}")
    for name in ("sample_aspect", "time_base", "average_rate"):
        value = getattr(info, name)
        if value is not None and not 0 < value.numerator < MOST_UNITS > value.denominator:
            raise ValueError(f"{name} {value}")
    counts = (info.frame_count, info.audio_channels, info.audio_rate)
    sizes = (info.coded_width, info.coded_height, *(n for n in counts if n is not None))
    if not all(0 <= number < MOST_UNITS for number in sizes):
        raise ValueError(f"numbers {sizes}")
    if info.kind not in ("video", "image", "sequence") or info.rotation not in (0, 90, 180, 270):
        raise ValueError(f"a {info.kind!r} turned by {info.rotation}")


def _check_options(header: Header) -> None:
    """Refuse options that no job has."""
    cuts = header.options["cuts"]
    listed = isinstance(cuts, list) and all(type(cut) is int and cut >= 0 for cut in cuts)
    if not listed and cuts not in ("auto", "none"):
        raise ValueError(f"cuts: {reprlib.repr(cuts)}")
    if not isinstance(header.finished, bool):
        raise ValueError(f"finished: {reprlib.repr(header.finished)}")
    header.solve.triangulate.refine.least_count(header.info.width, header.info.height)
