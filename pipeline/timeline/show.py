"""The look of a frame: a timeline at the times of one film."""

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.driven import Driven
from pipeline.timeline.expression import Expression
from pipeline.timeline.keyframes import Keyed
from pipeline.timeline.order import placed_in_time, told_at
from pipeline.timeline.targets import (
    OWN,
    PICTURE,
    found_in,
    kind_of_target,
    with_members,
)
from pipeline.timeline.timeline import Curve, Section, Timeline, Transition
from pipeline.timeline.written.place import Place


@dataclass(frozen=True)
class Setting:
    """How a section looks at a frame."""

    section: int
    """Number of the section."""
    look: Look
    """Its look, with the values of the curves."""
    opacity: float = 1.0
    """How much of the picture is seen before its background."""


@dataclass(frozen=True)
class Instant:
    """What is drawn at a frame."""

    scene: Setting
    """The section that it belongs to."""
    before: Setting | None = None
    """The section that is on its way out, if one is."""
    transition: Transition | None = None
    """How."""
    share: float = 1.0
    """How much of the way is done, above 0 and below 1 while there is a section before."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A section at its time."""

    section: Section
    """The section."""
    look: Look
    """Its look with the styles that are shown."""
    first: int
    """Number of its first frame."""
    ends: int
    """Number of the first frame that the transition into it does not reach."""
    lines: tuple[Driven, ...]
    """What changes in it."""
    made: dict[tuple[Any, ...], Setting] = field(default_factory=dict)
    """The scene of the last values: most frames differ from the one before in few."""


class Show:
    """A timeline at the times of one film.

    Args:
        timeline: What the file says.
        clock: The time of the film.
        looks: The looks of its sections, with the styles that are shown.
        notes: What is told of what it hears, one sentence each.

    Raises:
        OptionError: If sections or keys are not in order, or beats are counted and there are none.
    """

    def __init__(
        self,
        timeline: Timeline,
        clock: Clock,
        looks: tuple[Look, ...],
        notes: tuple[str, ...] = (),
    ) -> None:
        self.timeline = timeline
        self.clock = clock
        told: list[str] = []
        begins = list(placed_in_time(timeline, clock, looks, told))
        self.notes = (*notes, *told)
        self.sections: list[Placed] = []
        """The sections, in order."""
        for number, (section, look, begin) in enumerate(begins):
            end = begins[number + 1][2] if number + 1 < len(begins) else clock.end
            end = begin + 1.0 if end is None else end
            self._place(number, section, look, begin, end)

    def at(self, index: int, shown: Fraction | None = None, shot: int = 0) -> Instant:
        """What is drawn at a frame; it depends on nothing but the frame.

        Args:
            index: Number of the frame in the source.
            shown: When it is shown [s from the first frame]; None for an even rate.
            shot: Number of the frame with which its shot begins.

        Raises:
            OptionError: If an expression is no number there.
        """
        time = self.clock.time_of_frame(index, shown)
        frame = self.clock.frame_at(time)  # where frames come unevenly, their times count
        number = self.number_at(frame)
        placed = self.sections[number]
        scene = self._scene(number, index, time, shot)
        if frame >= placed.ends or number == 0:
            return Instant(scene)
        share = (frame - placed.first + 1) / (placed.ends - placed.first + 1)
        before = self._scene(number - 1, index, time, shot)
        return Instant(scene, before, placed.section.transition, share)

    def number_at(self, frame: int) -> int:
        """Number of the section that a frame belongs to; frames before the first are its own.

        Args:
            frame: Its number, at an even rate.
        """
        return max(0, bisect_right(self.sections, frame, key=lambda one: one.first) - 1)

    def _seen(self, first: int, last: int) -> Iterator[tuple[int, Placed, int, int]]:
        """Sections that are seen from one frame to another, with the first and the last frame."""
        for number, placed in enumerate(self.sections):
            later = self.sections[number + 1] if number + 1 < len(self.sections) else None
            begin = max(first, placed.first) if number else first
            end = last if later is None else min(last, max(later.first, later.ends) - 1)
            if begin <= end:
                yield number, placed, begin, end

    def _scene(self, number: int, index: int, time: float, shot: int) -> Setting:
        placed = self.sections[number]
        seen = [line for line in placed.lines if not line.target.is_mesh]
        values = tuple(line.at(index, time, shot) for line in seen)
        if values not in placed.made:
            placed.made.clear()
            placed.made[values] = _scene_of(number, placed, seen, values)
        return placed.made[values]

    def foreseen(self, first: int, last: int) -> list[Setting]:
        """Scenes of every kind that some frames will show, as far as that can be told.

        Args:
            first: Number of the first frame that is drawn.
            last: Number of the last one.
        """
        found: list[Setting] = []
        for number, placed, begin, end in self._seen(first, last):
            frames = {begin, end}
            for line in placed.lines:
                if not line.target.is_mesh:
                    frames |= line.turns(begin, end)
            shown = sorted(f for f in frames if begin <= f <= end)
            found += [self._scene(number, f, self.clock.time_of_frame(f), f) for f in shown]
        return found or [self._scene(0, first, self.clock.time_of_frame(first), first)]

    @property
    def transitions(self) -> set[str]:
        """Kinds of transitions that there are."""
        return {one.section.transition.kind for one in self.sections if one.ends > one.first}

    def mesh_at(self, index: int, name: str) -> float | None:
        """What changes meshes, at a frame; None where the file says nothing.

        Args:
            index: Number of the frame in the source.
            name: One of `targets.MESH`.
        """
        placed = self.sections[self.number_at(index)]
        for line in placed.lines:
            if str(line.target) == name:
                return float(line.at(index, self.clock.time_of_frame(index), 0))
        return placed.section.mesh.get(name)

    def check(self, first: int, last: int, *, is_drawn: bool = True) -> None:
        """Find expressions that are no numbers before anything is drawn.

        Args:
            first: Number of the first frame that is looked at.
            last: Number of the last one.
            is_drawn: Whether frames are drawn; else only what changes meshes is looked at.

        Raises:
            OptionError: If there is one.
        """
        for _, placed, begin, end in self._seen(first, last):
            for line in placed.lines:
                if isinstance(line.course, Expression) and (is_drawn or line.target.is_mesh):
                    line.values(begin, end)

    def held(self, first: int, last: int) -> tuple[str, ...]:
        """What is told of expressions that leave the bounds of their parameters, once for each.

        Args:
            first: Number of the first frame that is looked at.
            last: Number of the last one.
        """
        told: dict[Place, str] = {}
        for _, placed, begin, end in self._seen(first, last):
            for line in placed.lines:
                if isinstance(line.course, Expression) and line.course.place not in told:
                    note = line.held(begin, end)
                    if note is not None:
                        told[line.course.place] = f"{line.course.place}: {note}"
        return tuple(told.values())

    def _place(self, number: int, section: Section, look: Look, begin: float, end: float) -> None:
        """Put a section at its time."""
        clock, timeline = self.clock, self.timeline
        first = clock.frame_at(begin)
        ends = first
        if number and section.transition.kind != "cut":
            place = section.place_of("transition")
            with told_at(place):
                over = clock.later(begin, section.transition.span)
            most = section.transition.most
            if most is not None and clock.end is not None:
                over = min(over, begin + float(most) * clock.end)
            ends = clock.frame_at(over)
            if ends > clock.frame_at(end):
                raise place.error(
                    f"the transition of {section.transition.span} into {section.name} is longer "
                    f"than the section, {end - begin:.2f} s; shorten it"
                )
        own = {curve.target for curve in section.curves}
        whole = (0.0, clock.end or end)
        lines = [
            *_lines([c for c in timeline.curves if c.target not in own], look, clock, 0.0, whole),
            *_lines(section.curves, look, clock, begin, (begin, end)),
        ]
        self.sections.append(Placed(section, look, first, ends, tuple(lines)))


def _lines(
    curves: "tuple[Curve, ...] | list[Curve]",
    look: Look,
    clock: Clock,
    start: float,
    span: tuple[float, float],
) -> Iterator[Driven]:
    """The curves that are seen in a look."""
    for curve in curves:
        kind = kind_of_target(curve.target, look)
        if kind is None:
            continue
        course: Keyed | Expression
        if not isinstance(curve.course, Expression):
            course = Keyed.of(curve.course, clock, start)
        elif curve.target.is_mesh and curve.course.changes_with_shots:
            raise curve.place.error(
                f"{curve.target}: meshes are solved before shots are known; leave shot out"
            )
        else:
            course = curve.course
        yield Driven(curve.target, found_in(look, curve.target), kind, course, clock, span)


def _scene_of(number: int, placed: Placed, lines: list[Driven], values: tuple[Any, ...]) -> Setting:
    """The look of a section with some values in it."""
    look, opacity = placed.look, 1.0
    changes: dict[tuple[str, int | None], dict[str, Any]] = {}
    members: dict[tuple[str, int | None], Any] = {}
    own: Mapping[str, Any] = {}
    for line, value in zip(lines, values, strict=True):
        target = line.target
        if line.kind.name == "int":
            value = int(value)
        if not target.owner:
            if target.parameter == PICTURE:
                opacity = value
            elif target.parameter in OWN:
                own = {**own, target.parameter: value}
            continue
        assert line.slot is not None
        key = line.slot.field, line.slot.place
        members[key] = line.slot.member
        changes.setdefault(key, {})[target.parameter] = value
    changed = {key: replace(members[key], **given) for key, given in changes.items()}
    look = with_members(look, changed)
    return Setting(number, replace(look, **own) if own else look, opacity)
