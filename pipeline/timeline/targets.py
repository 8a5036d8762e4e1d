"""What curves change: `edges.width`, `edges[1].width` for the second of a name, `opacity`."""

import re
from argparse import ArgumentTypeError
from collections.abc import Iterator, Mapping
from dataclasses import Field, dataclass, fields, replace
from functools import lru_cache
from typing import Any

from pipeline.options.look import Look
from pipeline.options.members import parameters
from pipeline.options.nearest import nearest
from pipeline.options.values import kind_of, read_value
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry
from warp_kernels.styles import STYLES
from warp_kernels.styles.color import parse_color

_FORM = re.compile(r"(?:([\w-]+)(?:\[(\d+)\])?\.)?([\w-]+)")

PICTURE = "opacity"
"""What changes the whole picture."""
MESH = {"triangles": "int", "error": "float", "focus.strength": "float"}
"""What changes meshes, and of which kind it is."""
OWN = ("background",)
"""Fields of a look that may change and are no members."""
TONES = ("palette", "grade")
"""Fields of a look whose parameters may change as those of members do."""


@dataclass(frozen=True)
class Target:
    """A parameter of a member, or something of the whole picture."""

    owner: str
    """Name of the member, '' for none."""
    number: int
    """Which of those of the name, from 0."""
    parameter: str
    """Name of the parameter."""

    def __str__(self) -> str:
        number = f"[{self.number}]" if self.number else ""
        return f"{self.owner}{number}.{self.parameter}" if self.owner else self.parameter

    @classmethod
    def parse(cls, text: str) -> "Target":
        """Read a target.

        Args:
            text: What the user wrote.

        Raises:
            ValueError: If it has another form.
        """
        match = _FORM.fullmatch(text.strip())
        if match is None:
            raise ValueError(f"{text!r} is nothing that changes; write edges.width or opacity")
        parameter = match[3].replace("-", "_")
        return cls(match[1] or "", int(match[2] or 0), parameter)

    @property
    def is_mesh(self) -> bool:
        """Whether it changes meshes."""
        return str(self) in MESH


@dataclass(frozen=True)
class Slot:
    """A member of a look and where it stands."""

    name: str
    """Its name in its registry."""
    field: str
    """The field of the look."""
    place: int | None
    """Its number in the field, None for a field of one."""
    member: Any
    """The member."""


def slots_of(look: Look) -> Iterator[Slot]:
    """The members of a look, those of one registry in order; styles of regions come last."""
    for field in fields(look):
        registry: Registry[Any] | None = field.metadata.get("registry")
        held = getattr(look, field.name)
        if registry is None or held is None:
            continue
        if isinstance(held, tuple):
            for place, member in enumerate(held):
                yield Slot(registry.name_of(type(member)), field.name, place, member)
        else:
            yield Slot(registry.name_of(type(held)), field.name, None, held)
    for name, member in look.toned.items():
        if member is not None:
            yield Slot(name, name, None, member)
    for place, region in enumerate(look.regions):
        yield Slot(STYLES.name_of(type(region.style)), "regions", place, region.style)


def found_in(look: Look, target: Target) -> Slot | None:
    """The member that a target means, if a look has it."""
    named = _by_name(look).get(target.owner, [])
    return named[target.number] if target.number < len(named) else None


@lru_cache(maxsize=16)
def _by_name(look: Look) -> Mapping[str, list[Slot]]:
    """The members of a look by their names, in order: many curves ask for the same look."""
    found: dict[str, list[Slot]] = {}
    for slot in slots_of(look):
        found.setdefault(slot.name, []).append(slot)
    return found


def parameter_of(slot: Slot, target: Target) -> Field[Any]:
    """The field of a member that a target means.

    Raises:
        ValueError: If it has no such parameter.
    """
    known = {field.name: field for field in parameters(type(slot.member))}
    if target.parameter not in known:
        if not known:
            raise ValueError(f"{slot.name} has no parameters; leave the curve out")
        raise ValueError(
            f"{slot.name} has no parameter {target.parameter!r}; {nearest(target.parameter, known)}"
        )
    return known[target.parameter]


def with_members(look: Look, members: Mapping[tuple[str, int | None], Any]) -> Look:
    """A look with other members.

    Args:
        look: The look.
        members: The new ones, by field and number; see `Slot`.
    """
    changed: dict[str, Any] = {}
    for (field, place), member in members.items():
        if place is None:
            changed[field] = member
            continue
        held = list(changed.get(field, getattr(look, field)))
        is_region = field == "regions"
        held[place] = replace(held[place], style=member) if is_region else member
        changed[field] = tuple(held)
    return replace(look, **changed)


@dataclass(frozen=True)
class Kind:
    """What values a target takes."""

    name: str
    """`float`, `int`, `bool` or `str`."""
    least: float = float("-inf")
    """The least number."""
    most: float = float("inf")
    """The largest number."""
    choices: tuple[str, ...] = ()
    """The texts that it may be, empty for any."""
    is_color: bool = False
    """Whether it is a colour and nothing else."""
    is_fixed: bool = False
    """Whether what is drawn is built for each value: it may step, but not run."""

    @property
    def is_number(self) -> bool:
        """Whether values between two others are values too."""
        return self.name in ("float", "int")

    def read(self, text: str) -> Any:
        """Read a value.

        Args:
            text: What the user wrote.

        Raises:
            ValueError: If it is none; the message says what is.
        """
        if self.is_number:
            try:
                number = float(text)
            except ValueError:
                raise ValueError(f"{text!r} is no number; write one such as 1.5") from None
            if not self.least <= number <= self.most:
                bounds = f"between {self.least:g} and {self.most:g}"
                bounds = f"{self.least:g} or more" if self.most == float("inf") else bounds
                raise ValueError(f"{text}: must lie {bounds}")
            return number
        if self.name == "bool":
            try:
                return read_value("bool", text)
            except ArgumentTypeError as error:
                raise ValueError(str(error)) from error
        if self.is_color:
            parse_color(text)
        if self.choices and text not in self.choices:
            raise ValueError(f"{text!r}: {nearest(text, self.choices)}")
        return text

    def bounded(self, value: float) -> float:
        """The number nearest to one that is allowed, a whole one if only those are."""
        value = min(max(value, self.least), self.most)
        return float(round(value)) if self.name == "int" else value


def kind_of_target(target: Target, look: Look) -> Kind | None:
    """What values a target takes in a look, or None if that has no such member.

    Raises:
        ValueError: If its member has no such parameter.
    """
    if str(target) in MESH:
        least = 2.0 if target.parameter == "triangles" else 1e-6
        if target.owner:
            return Kind("float", 0.0, 4.0)
        return Kind(MESH[str(target)], least, 1e6)
    if not target.owner:
        if target.parameter == PICTURE:
            return Kind("float", 0.0, 1.0)
        if target.parameter in OWN:
            return Kind("str", is_color=True)
        return None
    slot = found_in(look, target)
    if slot is None:
        return None
    field = parameter_of(slot, target)
    if field.metadata.get("is_built"):
        raise ValueError(f"{target} does not change by a curve; give it to sections of their own")
    bounds = field.metadata.get("range", (float("-inf"), float("inf")))
    return Kind(
        kind_of(field).removesuffix(" | None"),
        float(bounds[0]),
        float(bounds[1]),
        choices=tuple(field.metadata.get("choices", ())),
        is_color=field.metadata.get("form") == "color",
        is_fixed=field.name in getattr(type(slot.member), "built_from", ()),
    )


@lru_cache(maxsize=1024)
def is_color(text: str) -> bool:
    """Whether a text is a colour."""
    try:
        parse_color(text)
    except OptionError:
        return False
    return True
