"""`trimotion listen`: what is heard in a sound, for people, programs and timelines."""

import argparse
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pipeline.commands.pipes import shown_name, source_name
from pipeline.progress import tell
from stages.hearing.beats_file import read_beats, write_beats, write_labels
from stages.hearing.formats.json_form import MOST_METER, as_json
from stages.hearing.heard import USUAL_METER, Heard
from stages.hearing.listening.listen import NO_BEAT, Listened, listen
from stages.hearing.listening.spectrum import FRAMES
from stages.look.sheet_sound import sheet_of_sound
from stages.media.naming import STILL_ENDINGS
from stages.media.writing.commit import true_place
from stages.media.writing.place import check_folder, check_name, is_among
from stages.media.writing.still_writer import write_picture
from warp_kernels.errors import OptionError, OutputError

SLOWEST, FASTEST = 30.0, 300.0
"""Beats a minute that may be said."""
REMEDY = "--bpm N lays beats of a tempo that you know, --beats FILE takes those of a file"


def listen_to(arguments: argparse.Namespace) -> str:
    """Listen, and write what is asked for.

    Args:
        arguments: What the user gave.

    Returns:
        What is told of it.

    Raises:
        TrimotionError: If the sound cannot be read, or a file not written.
    """
    source = Path(arguments.source)
    _check(arguments)
    written = _outputs(arguments)
    found = _heard(arguments, source)
    heard = found.heard
    if not arguments.quiet:
        called = source_name(arguments, source)
        for note in found.notes:
            remedy = f"; {REMEDY}" if note == NO_BEAT and arguments.bpm is None else ""
            tell(f"trimotion: note: {called}: {note}{remedy}", sys.stderr)
    for kind, path in written.items():
        if kind == "output":
            write_beats(heard, path)
        elif kind == "labels":
            write_labels(heard, path)
        else:
            write_picture(path, sheet_of_sound(heard, found.wave, FRAMES, source.name))
    if arguments.json:
        return as_json(heard).rstrip("\n")
    told = _told(heard, source_name(arguments, source), written)
    if any(shown_name(path) != path for path in written.values()):  # standard output is taken
        tell(told, sys.stderr)
        return ""
    return told


def _check(arguments: argparse.Namespace) -> None:
    """Find values that cannot be."""
    bpm, meter = arguments.bpm, arguments.meter
    if bpm is not None and not SLOWEST <= bpm <= FASTEST:
        raise OptionError(
            f"--bpm {bpm:g}: must lie between {SLOWEST:g} and {FASTEST:g} beats a minute; try 120"
        )
    if meter is not None and not 1 <= meter <= MOST_METER:
        raise OptionError(f"--meter {meter}: must lie between 1 and {MOST_METER}; a waltz has 3")
    if bpm is not None and arguments.beats is not None:
        raise OptionError("--bpm and --beats exclude each other; the file says where beats are")


def _outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """Files that are written, by their option; checked before anything is listened to."""
    named = {"output": arguments.output, "labels": arguments.labels, "plot": arguments.plot}
    found = {kind: Path(name) for kind, name in named.items() if name is not None}
    inputs = [Path(name) for name in (arguments.source, arguments.beats) if name is not None]
    for kind, path in found.items():
        if kind == "plot" and path.suffix.lower() not in STILL_ENDINGS:
            raise OptionError(f"--plot {path}: is one picture; name it .png or .jpg")
        place = true_place(path)
        check_name(path)
        if is_among(place, inputs):
            raise OutputError(path, "is the input itself", "choose another name")
        if place.exists() and not arguments.overwrite:
            raise OutputError(path, "exists already", "choose another name or --overwrite")
    if len({path.resolve() for path in found.values()}) < len(found):
        raise OptionError("-o, --labels and --plot: are one file; give them names of their own")
    for path in found.values():
        check_folder(path)
    return found


def _heard(arguments: argparse.Namespace, source: Path) -> Listened:
    """What is heard, with what a file says of it."""
    told = None if arguments.beats is None else read_beats(Path(arguments.beats))
    found = listen(source, arguments.bpm, arguments.meter or USUAL_METER)
    if told is None:
        return found
    heard = found.heard.told_by(told.with_downbeats(arguments.meter))
    notes = tuple(n for n in found.notes if n != NO_BEAT)
    if len(told.beats) == 1:
        notes += (
            f"{shown_name(Path(arguments.beats))} tells of one beat: those that are heard count",
        )
    return replace(found, heard=heard, notes=notes)


def _told(heard: Heard, called: str, written: Mapping[str, Path]) -> str:
    """For people."""
    tempo = "no beat"
    if heard.bpm is not None:
        tempo = f"{heard.bpm:.1f} beats a minute, {heard.meter} a bar"
    lines = [f"{called}: {_clock(heard.duration)}, {tempo}"]
    for name, times in (
        ("beats", heard.beats),
        ("bars", heard.downbeats),
        ("onsets", heard.onsets),
    ):
        ends = f", {_clock(times[0])} to {_clock(times[-1])}" if len(times) else ""
        lines.append(f"{name:<9}{len(times)}{ends}")
    lines += [f"sections {', '.join(mark.name for mark in heard.sections)}"] * bool(heard.sections)
    lines += [f"written  {shown_name(path)}" for path in written.values()]
    return "\n".join(lines)


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(float(seconds), 2), 60)
    return f"{int(minutes)}:{rest:05.2f}"
