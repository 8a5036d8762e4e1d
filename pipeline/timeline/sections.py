"""Read sections: when they begin, how they look, how one becomes the next."""

import re
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

from pipeline.options.build import values_of
from pipeline.options.command_line import Option, job_options
from pipeline.options.look import Look
from pipeline.options.nearest import nearest
from pipeline.timeline.curves import read_curves
from pipeline.timeline.targets import MESH, OWN, TONES, Target, kind_of_target
from pipeline.timeline.timeline import CUT, Section, Transition
from pipeline.timeline.times import START, When, parse_span, parse_when
from pipeline.timeline.written.place import Places, Table
from warp_kernels.errors import OptionError, TrimotionError

KEYS = ("from", "to", "name", "transition", "curves")
"""What a section has beside options."""
KINDS = ("cut", "fade", "wipe", "scatter", "grow")
"""How sections become others."""
DIRECTIONS = ("left", "right", "up", "down")
"""Where the border of a wipe goes."""
FORM = "write cut, fade 1 bar, wipe left 2s, scatter 1 bar or grow 1 bar"
"""How transitions are written, for messages."""


@cache
def section_options() -> Mapping[str, Option]:
    """The options that a section may have, by name: what of a look may change over time."""
    changing = {"regions", *OWN, *TONES}
    return {
        option.flag: option
        for option in job_options()
        if option.group == "look" and (option.registry is not None or option.dest in changing)
    }


def read_section(table: Mapping[str, Any], number: int, look: Look, places: Places) -> Section:
    """Read a section.

    Args:
        table: As TOML gives it.
        number: Which section it is, from 0.
        look: How the film looks where it says nothing.
        places: Where everything stands.

    Raises:
        OptionError: If it holds anything that cannot be; told with its line.
    """
    where: Table = ("section", number)
    known = (*KEYS, *section_options(), *MESH)
    for key in table:
        if key.replace("_", "-") not in known:
            place = places.of(where, key)
            raise place.error(f"unknown key {key!r} of a section; {nearest(key, known)}")
    own = _look(table, where, look, places)
    name = table.get("name", f"section {number + 1}")
    if not isinstance(name, str):
        raise places.of(where, "name").error(f"name = {name!r}: write a text in quotes")
    begin = _when(table, "from", where, places)
    if begin is None and number > 0:
        raise places.of(where).error('a section needs a time; write from = "bar 9" below')
    return Section(
        name=name,
        begin=begin or START,
        end=_when(table, "to", where, places),
        look=own,
        transition=_transition(table, where, places),
        curves=read_curves(table.get("curves", {}), (*where, "curves"), [own], places),
        mesh=_mesh(table, where, look, places),
        place=places.of(where),
        entries={key: places.of(where, key) for key in table},
    )


def _look(table: Mapping[str, Any], where: Table, look: Look, places: Places) -> Look:
    """The look of a section."""
    for key, value in table.items():
        option = section_options().get(key.replace("_", "-"))
        if option is None:
            continue
        place = places.of(where, key)
        try:
            given = option.value(value, key)
            look = replace(look, **{option.dest: values_of({option.dest: given})[option.dest]})
        except TrimotionError as error:
            text = str(error).removeprefix(f"--{option.flag} ")
            if isinstance(value, list):
                wrong = next((v for v in value if isinstance(v, str) and v in text), None)
                place = place if wrong is None else places.of_text(where, key, wrong)
            raise place.error(text) from error
    return look


def _when(table: Mapping[str, Any], key: str, where: Table, places: Places) -> When | None:
    if key not in table:
        return None
    place = places.of(where, key)
    try:
        return parse_when(str(table[key]))
    except ValueError as error:
        raise place.error(f"{key}: {error}") from error


def _mesh(table: Mapping[str, Any], where: Table, look: Look, places: Places) -> dict[str, float]:
    """What a section says of meshes."""
    found = {}
    flat = {k: v for k, v in table.items() if k in MESH}
    for name, value in flat.items():
        kind = kind_of_target(Target.parse(name), look)
        place = places.of(where, name)
        assert kind is not None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise place.error(f"{name} = {value!r}: write a number")
        try:
            found[name] = kind.read(str(value))
        except ValueError as error:
            raise place.error(f"{name} = {error}") from error
    return found


def _transition(table: Mapping[str, Any], where: Table, places: Places) -> Transition:
    """How the section before becomes this one."""
    if "transition" not in table:
        return CUT
    place = places.of(where, "transition")
    try:
        return parse_transition(table["transition"])
    except (ValueError, OptionError) as error:
        raise place.error(f"transition: {error}") from error


def parse_transition(text: Any) -> Transition:
    """Read a transition.

    Args:
        text: What the user wrote.

    Raises:
        ValueError: If it is none; the message says what is.
    """
    if not isinstance(text, str) or not text.partition(",")[0].strip():
        raise ValueError(f"{text!r} is none; {FORM}")
    plain, _, bound = text.partition(",")
    words = plain.lower().split()
    kind = words.pop(0)
    if kind not in KINDS:
        raise ValueError(f"no {kind!r}; {nearest(kind, KINDS)}")
    direction = ""
    if kind == "wipe":
        if not words or words[0] not in DIRECTIONS:
            raise ValueError(f"{text!r} has no direction; write wipe left 2s, right, up or down")
        direction = words.pop(0)
    if kind == "cut":
        if words:
            raise ValueError(f"{text!r}: a cut takes no time; write cut, or fade {' '.join(words)}")
        return CUT
    most = _bound(bound.strip().lower()) if bound else None
    span = parse_span(" ".join(words) or "1s")
    if span.amount == 0:
        raise ValueError(f"{text!r} takes no time; write cut")
    return Transition(kind, span, most, direction)


def _bound(text: str) -> Fraction:
    """The part of the film that a transition takes at most."""
    match = re.fullmatch(r"(\d+(?:\.\d+)?) *% at most", text)
    if match is None or not 0 < Fraction(match[1]) <= 100:
        raise ValueError(f"{text!r} bounds nothing; write fade 1 bar, 10% at most")
    return Fraction(match[1]) / 100
