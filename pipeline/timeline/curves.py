"""Read curves: a table of targets and what becomes of them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pipeline.options.look import Look
from pipeline.timeline.easings import STEPS
from pipeline.timeline.expression import parse_expression
from pipeline.timeline.keyframes import Key, is_keyframes, parse_keys
from pipeline.timeline.targets import (
    MESH,
    OWN,
    PICTURE,
    TONES,
    Kind,
    Target,
    kind_of_target,
    slots_of,
)
from pipeline.timeline.timeline import Curve
from pipeline.timeline.times import START
from pipeline.timeline.written.place import Place, Places, Table
from warp_kernels.errors import OptionError


def read_curves(
    table: Any, where: Table, looks: Sequence[Look], places: Places
) -> tuple[Curve, ...]:
    """Read a table of curves.

    Args:
        table: As TOML gives it.
        where: Which table it is.
        looks: The looks in which they may be seen, at least one.
        places: Where everything stands.

    Raises:
        OptionError: If a curve changes nothing, or its text cannot be read.
    """
    if not isinstance(table, dict):
        here = places.of(where[:-1], str(where[-1]))
        raise here.error(f"{where[-1]}: write [{where[-1]}] and a line for each curve below")
    curves: dict[Target, Curve] = {}
    for name, value in _flat(table):
        key = name.replace(" ", "")
        place = places.of(where, key)
        if place == places.of(where):
            place = places.of((*where, key.split(".")[0]), key.partition(".")[2])
        curve = _curve(name, value, place, looks)
        if curve.target in curves:
            raise place.error(f"{name} has two curves; leave one out")
        curves[curve.target] = curve
    return tuple(curves.values())


def _flat(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Entries with whole names: without quotes a name with a dot is a table in a table."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


def _curve(name: str, value: Any, place: Place, looks: Sequence[Look]) -> Curve:
    try:
        target = Target.parse(name)
        kinds = [kind for look in looks if (kind := kind_of_target(target, look)) is not None]
    except ValueError as error:
        raise place.error(error) from error
    if not kinds:
        raise place.error(_unseen(target, looks))
    kind = kinds[0]
    if isinstance(value, bool) and kind.name == "bool":
        value = str(value).lower()
    if isinstance(value, int | float) and not isinstance(value, bool):
        value = f"{value}"
    if not isinstance(value, str) or not value.strip():
        raise place.error(f"{name} = {value!r}: write keyframes or an expression in quotes")
    if is_keyframes(value):
        keys = parse_keys(value, place, kind.read)
        _check_steps(target, kind, keys)
        return Curve(target, keys, place)
    if kind.is_number and not kind.is_fixed:
        begin = len(value) - len(value.lstrip())
        return Curve(target, parse_expression(value.strip(), place.after(begin)), place)
    try:
        return Curve(target, (Key(START, kind.read(value.strip()), "step", place),), place)
    except (ValueError, OptionError) as error:
        raise place.error(f"{error}; {target} takes keyframes, such as 0s: VALUE") from error


def _check_steps(target: Target, kind: Kind, keys: Sequence[Key]) -> None:
    """Refuse values that run where each must be built."""
    values = {key.value for key in keys}
    for key in keys[:-1]:
        if kind.is_fixed and len(values) > 1 and key.ease not in STEPS:
            raise key.place.error(
                f"{target} cannot change little by little: what is drawn is built for each value; "
                "write step after the value"
            )


def _unseen(target: Target, looks: Sequence[Look]) -> str:
    """What to say about a target that no look has."""
    names: dict[str, int] = {}
    for look in looks:
        counts: dict[str, int] = {}
        for slot in slots_of(look):
            counts[slot.name] = counts.get(slot.name, 0) + 1
        names |= {name: max(count, names.get(name, 0)) for name, count in counts.items()}
    if not target.owner:
        known = ", ".join((PICTURE, *OWN, *MESH))
        return f"{target}: nothing of that name changes; write STYLE.PARAMETER, or one of {known}"
    if target.owner in names:
        return (
            f"{target}: there are {names[target.owner]} of {target.owner}, counted from 0; "
            f"write {target.owner}[{names[target.owner] - 1}].{target.parameter}"
        )
    if target.owner in TONES:
        return f'{target}: no look has a {target.owner}; give one, such as palette = "sunset"'
    known = f"there are {', '.join(names)}" if names else "no style is named"
    return f"{target}: nothing shows {target.owner} ({known}); add it to a style = [...]"
