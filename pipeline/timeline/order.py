"""When the sections of a timeline begin and end in one film: in order, and none over another."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.timeline import CUT, Section, Timeline
from pipeline.timeline.times import Unit, When
from pipeline.timeline.written.place import Place
from warp_kernels.errors import OptionError


def placed_in_time(
    timeline: Timeline, clock: Clock, looks: tuple[Look, ...], told: list[str]
) -> Iterator[tuple[Section, Look, float]]:
    """Sections with their looks and beginnings [s], and the gaps that ends leave between them.

    Args:
        timeline: The file.
        clock: The time of the film.
        looks: That of the command line, and those of the sections.
        told: Takes what is to be told, one sentence each.

    Raises:
        OptionError: If sections overlap, are not in order or lie outside of the film.
    """
    base, before = looks[0], 0.0
    sections = _stated(timeline, clock, looks[1:])
    for number, (section, look) in enumerate(sections):
        begin = _begin_of(section, number, clock, before)
        earlier = sections[number - 1][0] if number else None
        if earlier is not None:
            gap = _end_of(earlier, before, clock)
            _check_order(section, begin, earlier, before, gap, clock)
            if gap is not None and gap < begin - 0.5 / float(clock.rate):
                yield _gap(timeline, section, gap, base)
        yield section, look, begin
        before = begin
    last = sections[-1][0]
    gap = _end_of(last, before, clock)
    if gap is None:
        return
    if clock.end is None or gap < clock.end:
        yield _gap(timeline, last, gap, base)
    elif clock.frame_at(gap) > clock.frame_at(clock.end):
        told.append(
            f"{last.place_of('to')}: {last.name} would end at {clock.name_of(gap)}, and the film "
            f"ends at {clock.name_of(clock.end)}"
        )


def _stated(
    timeline: Timeline, clock: Clock, looks: tuple[Look, ...]
) -> list[tuple[Section, Look]]:
    """The sections with their looks, without one before them that would have no frame."""
    found = list(zip(timeline.sections, looks, strict=True))
    if len(found) > 1 and found[0][0].is_assumed and _is_first(found[1][0], clock):
        found.pop(0)
    first = found[0][0]
    if first.transition.kind != "cut":
        raise first.place_of("transition").error(
            f"{first.name} begins with the film, and nothing is before it; leave transition out, "
            'or write opacity = "start: 0, 1s: 1" below [section.curves]'
        )
    return found


def _is_first(section: Section, clock: Clock) -> bool:
    """Whether a section begins with the first frame."""
    if clock.count == 1 and section.begin.needs_beats:  # that it has one frame is told elsewhere
        return False
    return clock.frame_at(_time_of(section, "from", section.begin, 0.0, clock)) == clock.first


def _time_of(section: Section, key: str, when: When, before: float, clock: Clock) -> float:
    """When a section begins or ends [s]."""
    with told_at(section.place_of(key)):
        return clock.time_of(when, before)


def _begin_of(section: Section, number: int, clock: Clock, before: float) -> float:
    """When a section begins [s]."""
    place = section.place_of("from")
    if number and clock.count == 1:
        raise place.error(
            f"{section.name} would begin later, and the source has one frame; take a timeline "
            "of one section, or a film"
        )
    begin = _time_of(section, "from", section.begin, before, clock)
    frame = clock.frame_at(begin)
    if frame < clock.first:
        raise place.error(
            f"{section.name} begins at {clock.name_of(begin)}, before the film does; leave it "
            f"out, or begin it later{_first_bar(section.begin, clock)}"
        )
    if clock.count is not None and frame >= clock.first + clock.count:
        raise place.error(
            f"{section.name} begins at {clock.name_of(begin)}, and the film ends at "
            f"{clock.name_of(clock.end or 0.0)}; leave it out, or begin earlier"
        )
    return begin


def _first_bar(when: When, clock: Clock) -> str:
    """The first bar of the film, where bars are counted."""
    if when.span.unit is not Unit.BARS or when.is_relative:
        return ""
    return f": bar {math.ceil(float(clock.beats.bar_at(0.0)) - 1e-3)} is the first in it"


def _end_of(section: Section, begin: float, clock: Clock) -> float | None:
    """When a section ends if it says so [s]."""
    if section.end is None:
        return None
    end = _time_of(section, "to", section.end, begin, clock)
    if clock.frame_at(end) <= clock.frame_at(begin):
        raise section.place_of("to").error(
            f"{section.name} ends at {clock.name_of(end)} and begins at {clock.name_of(begin)}; "
            'write a later end, or to = "end"'
        )
    return end


def _check_order(
    section: Section,
    begin: float,
    earlier: Section,
    before: float,
    end: float | None,
    clock: Clock,
) -> None:
    """Refuse a section that begins before the one before it begins or ends."""
    frame, first = clock.frame_at(begin), clock.frame_at(before)
    if frame <= first:
        raise section.place_of("from").error(
            f"{section.name} begins at {clock.name_of(begin)} (frame {frame}), and {earlier.name}, "
            f"which stands before it, at {clock.name_of(before)} (frame {first}); put sections in "
            "order, each a frame or more after the last"
        )
    if end is not None and frame < clock.frame_at(end):
        raise earlier.place_of("to").error(
            f"{earlier.name} ends at {clock.name_of(end)}, and {section.name} begins before that, "
            f"at {clock.name_of(begin)}; end {earlier.name} at {_seconds(begin)}, or begin "
            f"{section.name} at {_seconds(end)}"
        )


def _seconds(time: float) -> str:
    """A time as files have it."""
    return f"{time:.3f}".rstrip("0").rstrip(".") + "s"


def _gap(
    timeline: Timeline, near: Section, begin: float, base: Look
) -> tuple[Section, Look, float]:
    """What is seen where a section has ended and none has begun."""
    section = replace(near, name="between", look=base, curves=(), mesh={}, transition=CUT)
    return section, base, begin


@contextmanager
def told_at(place: Place) -> Iterator[None]:
    """What a time cannot be is told with the place where it stands.

    Args:
        place: The place.
    """
    try:
        yield
    except OptionError as error:
        raise place.error(error) from error
