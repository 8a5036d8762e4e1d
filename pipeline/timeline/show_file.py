"""Read a timeline: a TOML file, or the name of a shipped one."""

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pipeline.options.look import Look
from pipeline.options.nearest import nearest
from pipeline.timeline.curves import read_curves
from pipeline.timeline.sections import read_section
from pipeline.timeline.timeline import (
    CUT,
    TEMPLATES,
    Section,
    Timeline,
    shipped_timelines,
)
from pipeline.timeline.times import START
from pipeline.timeline.written.place import Place, Places, Table, places_of
from pipeline.timeline.written.toml_faults import fault_of
from stages.hearing.beats_file import read_beats
from stages.hearing.heard import Heard
from stages.media.text_file import read_text
from warp_kernels.errors import OptionError, TrimotionError

TOP = ("title", "beats", "bpm", "meter", "section", "curves")
"""What stands on top."""
MOST_TEMPO = 1000.0
"""Beats a minute; more are a mistake."""


def read_timeline(name: str, look: Look) -> Timeline:
    """Read a timeline.

    Args:
        name: A TOML file, or the name of a shipped one.
        look: How the film looks where the file says nothing.

    Raises:
        OptionError: If it cannot be read, or holds anything that cannot be; told with its line.
    """
    shipped = name in shipped_timelines()
    path = TEMPLATES / f"{name}.toml" if shipped else Path(name)
    try:
        text = read_text(path)
    except OSError as error:
        raise OptionError(
            f"--timeline {name}: cannot be read ({str(error.strerror).lower()}); give a TOML file "
            f"or one of {', '.join(shipped_timelines())}"
        ) from error
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise OptionError(
            f"--timeline {name}: is no text in UTF-8 (line {line}); save it as UTF-8, or give a "
            "TOML file"
        ) from error
    except ValueError as error:
        raise OptionError(f"--timeline {name}: is no text ({error}); give a TOML file") from error
    return parse_timeline(text, f"{name}.toml" if shipped else name, look)


def parse_timeline(text: str, file: str, look: Look) -> Timeline:
    """Read the text of a timeline.

    Args:
        text: The TOML.
        file: Its name, for messages.
        look: How the film looks where it says nothing.

    Raises:
        OptionError: As `read_timeline` does.
    """
    tables = _tables(text, file)
    places = places_of(text, file)
    for key in tables:
        if key not in TOP:
            here = places.of((), key)
            here = here if here.line > 1 else places.of((key,))
            raise here.error(f"unknown key {key!r}; {nearest(key, TOP)}")
    listed = tables.get("section", [])
    if not isinstance(listed, list) or not all(isinstance(one, dict) for one in listed):
        raise places.of((), "section").error("section: write [[section]] in double brackets")
    sections = [read_section(one, number, look, places) for number, one in enumerate(listed)]
    first = Place(file)
    if not sections or sections[0].begin != START:
        assumed = Section("start", START, None, look, CUT, (), {}, first, is_assumed=True)
        sections.insert(0, assumed)
    looks = [section.look for section in sections]
    curves = read_curves(tables.get("curves", {}), ("curves",), looks, places)
    bpm, meter = _tempo(tables, places)
    beats = _beats(tables, places)
    if beats is not None:
        beats = beats.with_downbeats(meter if "meter" in tables else None)
    return Timeline(file, tuple(sections), curves, bpm, meter, "meter" in tables, beats)


def _tables(text: str, file: str) -> dict[str, Any]:
    """The tables of a TOML file."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # plain ones are of numbers with many digits
        raise fault_of(error, text, file) from error


def _beats(tables: Mapping[str, Any], places: Places) -> Heard | None:
    """The beats of a file that the timeline names; it lies where the timeline is, or here."""
    name, place = tables.get("beats"), places.of((), "beats")
    if name is None:
        return None
    if not isinstance(name, str) or not name:
        raise place.error(f"beats = {name!r}: write the name of a file that trimotion reads")
    beside = Path(places.file).parent / name
    try:
        return read_beats(beside if os.path.isfile(beside) else Path(name))
    except OSError as error:  # a name that no file can have
        reason = str(error.strerror).lower()
        raise place.error(f"beats = {name[:30]!r}: {reason}; write the name of a file") from error
    except TrimotionError as error:
        raise place.error(error) from error


def _tempo(tables: Mapping[str, Any], places: Places) -> tuple[float | None, int]:
    """Tempo and meter where nothing else tells them."""
    bpm, meter = tables.get("bpm"), tables.get("meter", 4)
    top: Table = ()
    is_number = isinstance(bpm, int | float) and not isinstance(bpm, bool)
    if bpm is not None and not (is_number and 1 <= bpm <= MOST_TEMPO):
        raise places.of(top, "bpm").error(f"bpm = {bpm!r}: write beats a minute, such as 120")
    if not isinstance(meter, int) or isinstance(meter, bool) or not 1 <= meter <= 32:
        raise places.of(top, "meter").error(f"meter = {meter!r}: write beats of a bar, such as 4")
    return None if bpm is None else float(bpm), meter
