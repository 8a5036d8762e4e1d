"""What a file is, for people and for programs."""

import dataclasses
import json
from pathlib import Path

from pipeline.options.edit_log import EditLog
from pipeline.printable import printable
from pipeline.track import SourceIdentity, TrackReader, is_track
from pipeline.track.plain_values import to_plain
from pipeline.track.schema import FORMAT
from stages.focus import spelled
from stages.media import MediaInfo, probe
from warp_kernels.errors import OptionError

MOST_SHOTS = 12
"""Shots of a track that are listed for people."""


def describe(path: Path, *, as_json: bool, called: str | None = None) -> str:
    """Describe a source or a mesh track.

    Args:
        path: A video, a still, a pattern of numbered stills or a track.
        as_json: Whether to give JSON rather than lines.
        called: What the user calls it, if that is another name: a pipe, an address.

    Raises:
        MediaError: If it cannot be read.
        TrackError: If it is a damaged track; all of its frames are looked at.
        OptionError: If a pattern has more than one number field.
    """
    name = called or str(path)
    if is_track(path):
        with TrackReader(path) as track:
            track.check()
            facts, rows = {"file": name, **_facts(track)}, _track_rows(track)
    else:
        info = probe(path)
        facts, rows = {**info.as_dict(), "path": name}, _rows(info)
    return json.dumps(facts, indent=2) if as_json else _aligned([("file", name), *rows])


def edits_in(path: Path) -> str:
    """The edits by hand that are in force in a track, one a line as JSON.

    Args:
        path: The track.

    Raises:
        OptionError: If it is another file.
        TrackError: If it is damaged.
    """
    from pipeline.edit_log.json_lines import as_json_lines

    if not is_track(path):
        raise OptionError(f"info --edits: {path} is no mesh track; give what trimotion solve wrote")
    return as_json_lines(_log_in(path))


def _log_in(track: Path) -> EditLog:
    """The edits that are in force in a track."""
    from pipeline.edit_log.journal import EditJournal

    with EditJournal(track) as journal:
        return journal.log


def _aligned(rows: list[tuple[str, str]]) -> str:
    width = max(len(label) for label, _ in rows)
    return "\n".join(f"{label:<{width}}  {printable(value)}" for label, value in rows)


def _facts(track: TrackReader) -> dict[str, object]:
    """All that a track says about itself, but its meshes."""
    header = track.header
    return {
        "kind": "track",
        "format": FORMAT,
        "program": header.program,
        "libraries": dict(header.libraries),
        "finished": header.finished,
        "frame_range": str(header.frame_range),
        "shots": list(track.shots),
        "model": header.model.name,
        "source": to_plain(header.source),
        "info": {**header.info.as_dict(), **_called(header.source)},
        "options": {**header.options, "focus": spelled(header.solve.foci).split()},
        "focus": spelled(header.solve.foci),
        "frames": [dataclasses.asdict(row) for row in track.rows],
    }


def _called(source: SourceIdentity) -> dict[str, str]:
    """Whence a source came that was no file: as a path an address loses a slash."""
    return {} if source.is_file else {"path": source.path}


def _track_rows(track: TrackReader) -> list[tuple[str, str]]:
    """Labels and values that say what a track is."""
    header, rows, shots = track.header, track.rows, track.shots
    ends = f"{rows[0].frame} to {rows[-1].frame}, {len(rows)} in all" if rows else "none"
    if not header.finished:
        ends += f"; unfinished, {header.frame_range} were asked for"
    starts = ", ".join(map(str, shots[:MOST_SHOTS])) + (", ..." if len(shots) > MOST_SHOTS else "")
    told = [
        ("kind", f"mesh track of format {FORMAT}, by trimotion {header.program}"),
        ("source", header.source.path),
        ("size", _size(header.info)),
        ("frames", ends),
        ("shots", f"{len(shots)}, from frames {starts}" if shots else "none"),
        ("colours", header.model.name),
        ("focus", _focus(spelled(header.solve.foci))),
    ]
    edits = _log_in(track.path).edits
    if edits:
        told.append(("edits", f"{len(edits)}, which --edits prints"))
    if rows:
        counts = [row.triangle_count for row in rows]
        told.append(("triangles", f"{min(counts)} to {max(counts)}"))
        told.append(("mean rmse", f"{sum(row.rmse for row in rows) / len(rows):.2f}"))
    return told


def _focus(spelled: str) -> str:
    """Where errors counted more; what `auto` means is not in its name."""
    return f"{spelled} (faces, where there are any)" if spelled == "auto" else spelled


def _rows(info: MediaInfo) -> list[tuple[str, str]]:
    """Labels and values that say something about this source."""
    rows = [
        ("kind", f"{info.kind} ({info.container})"),
        ("size", _size(info)),
        ("codec", f"{info.codec}, {info.pixel_format}"),
        ("colour", _color(info)),
    ]
    if info.frame_count is not None and info.kind != "image":
        numbers = f", numbered from {info.first_frame}" if info.first_frame else ""
        rows.append(("frames", f"{info.frame_count}{numbers}"))
    if info.average_rate is not None:
        rows.append(("rate", f"{float(info.average_rate):.6g} frames a second"))
    if info.duration is not None:
        rows.append(("duration", f"{float(info.duration):.3f} s"))
    if info.start_time:
        rows.append(("starts at", f"{float(info.start_time):.3f} s"))
    if info.kind != "image":
        rows.append(("time base", f"{info.time_base} s"))
    rows.append(("audio", _audio(info)))
    rows.extend(("note", note) for note in info.notes)
    return rows


def _size(info: MediaInfo) -> str:
    text = f"{info.width}x{info.height} pixels"
    shown = [f"turned by {info.rotation}"] if info.rotation else []
    shown += ["mirrored"] if info.mirrored else []
    if shown:
        text += f" (stored {info.coded_width}x{info.coded_height}, {', '.join(shown)})"
    if info.sample_aspect != 1:
        text += f", pixel aspect {info.sample_aspect}"
    return text


def _color(info: MediaInfo) -> str:
    text = f"{info.color_matrix}, {info.color_range} range"
    return text if info.hdr is None else f"{text}, HDR ({info.hdr})"


def _audio(info: MediaInfo) -> str:
    if info.audio_codec is None:
        return "none"
    if info.audio_channels is None:
        return info.audio_codec
    noun = "channel" if info.audio_channels == 1 else "channels"
    return f"{info.audio_codec}, {info.audio_channels} {noun}"
