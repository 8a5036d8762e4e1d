"""What a file is, for people and for programs."""

import json
from pathlib import Path

from stages.media import MediaInfo, probe


def describe(path: Path, *, as_json: bool) -> str:
    """Describe a source.

    Args:
        path: A video, a still or a pattern of numbered stills.
        as_json: Whether to give JSON rather than lines.

    Raises:
        MediaError: If it cannot be read.
        OptionError: If a pattern has more than one number field.
    """
    info = probe(path)
    if as_json:
        return json.dumps(info.as_dict(), indent=2)
    rows = _rows(info)
    width = max(len(label) for label, _ in rows)
    return "\n".join(f"{label:<{width}}  {value}" for label, value in rows)


def _rows(info: MediaInfo) -> list[tuple[str, str]]:
    """Labels and values that say something about this source."""
    rows = [
        ("file", str(info.path)),
        ("kind", f"{info.kind} ({info.container})"),
        ("size", _size(info)),
        ("codec", f"{info.codec}, {info.pixel_format}"),
        ("colour", _color(info)),
    ]
    if info.frame_count is not None and info.kind != "image":
        rows.append(("frames", str(info.frame_count)))
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
    if info.rotation:
        text += f" (stored {info.coded_width}x{info.coded_height}, turned by {info.rotation})"
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
