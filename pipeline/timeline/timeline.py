"""What a file says of a film: sections, transitions and curves, not yet at their times."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from pipeline.options.look import Look
from pipeline.timeline.expression import Expression
from pipeline.timeline.keyframes import Key
from pipeline.timeline.signals import STRENGTHS
from pipeline.timeline.targets import MESH, Target
from pipeline.timeline.times import START, Span, When
from pipeline.timeline.written.place import Place
from stages.hearing.heard import Heard

TEMPLATES = Path(__file__).parent / "templates"
"""Folder of the timelines that are known by name alone."""


def shipped_timelines() -> list[str]:
    """Names of the timelines that come with the program."""
    return sorted(path.stem for path in TEMPLATES.glob("*.toml"))


@dataclass(frozen=True, eq=False)
class Curve:
    """Something that changes."""

    target: Target
    """What."""
    course: tuple[Key, ...] | Expression
    """How."""
    place: Place
    """Where it stands in the file."""

    @property
    def needs_beats(self) -> bool:
        """Whether it looks at beats or bars."""
        if isinstance(self.course, Expression):
            return self.course.needs_beats
        return any(key.when.needs_beats for key in self.course)


@dataclass(frozen=True)
class Transition:
    """How one section becomes the next."""

    kind: str
    """`cut`, `fade`, `wipe`, `scatter` or `grow`."""
    span: Span
    """How long it takes, from the moment at which the section begins."""
    most: Fraction | None = None
    """The part of the film that it takes at most."""
    direction: str = ""
    """Of a wipe: `left`, `right`, `up` or `down`."""


CUT = Transition("cut", START.span)
"""At once."""


@dataclass(frozen=True, eq=False)
class Section:
    """A part of the film with a look of its own."""

    name: str
    """What the user calls it, or its number."""
    begin: When
    """When it begins."""
    end: When | None
    """When it ends if it is not with the next one."""
    look: Look
    """How it looks, but for curves."""
    transition: Transition
    """How the section before becomes this one."""
    curves: tuple[Curve, ...]
    """What changes in it alone."""
    mesh: Mapping[str, float]
    """What changes meshes, by the names of `targets.MESH`."""
    place: Place
    """Where its header stands in the file."""
    entries: Mapping[str, Place] = field(default_factory=dict)
    """Where its entries stand, by key."""
    is_assumed: bool = False
    """Whether no file says it: it is what is seen before the first one that does."""

    def place_of(self, key: str) -> Place:
        """Where an entry stands, or the header if there is none.

        Args:
            key: Its key.
        """
        return self.entries.get(key, self.place)


@dataclass(frozen=True, eq=False)
class Timeline:
    """A file."""

    file: str
    """Its name."""
    sections: tuple[Section, ...]
    """Its sections, in order."""
    curves: tuple[Curve, ...]
    """What changes wherever it is seen."""
    bpm: float | None = None
    """The tempo where nothing is heard."""
    meter: int = 4
    """Beats of a bar where nothing is heard."""
    says_meter: bool = False
    """Whether the file says so."""
    beats: Heard | None = None
    """What is heard, if the file names a file that says so."""

    @property
    def hears_strengths(self) -> bool:
        """Whether a curve looks at strengths or onsets."""
        return self.hears_onsets or bool(self._names & STRENGTHS.keys())

    @property
    def hears_onsets(self) -> bool:
        """Whether a curve looks at onsets."""
        return "onset" in self._names

    @property
    def _names(self) -> frozenset[str]:
        """Variables that curves look at."""
        courses = [curve.course for curve in self.all_curves]
        named = (one.names for one in courses if isinstance(one, Expression))
        return frozenset().union(*named)

    @property
    def all_curves(self) -> list[Curve]:
        """All that changes, with the sections' own."""
        return [*self.curves, *(curve for one in self.sections for curve in one.curves)]

    @property
    def changes_meshes(self) -> bool:
        """Whether anything of it changes meshes."""
        return any(self.changes(name) for name in MESH)

    def changes(self, name: str) -> bool:
        """Whether a curve or a section says something of meshes.

        Args:
            name: One of `targets.MESH`.
        """
        said = any(name in section.mesh for section in self.sections)
        return said or any(str(curve.target) == name for curve in self.all_curves)

    @property
    def needs_sound(self) -> bool:
        """Whether it must be known what is heard: nothing is listened to in vain."""
        moments = [when for one in self.sections for when in (one.begin, one.end) if when]
        spans = [one.transition.span for one in self.sections]
        return (
            any(when.needs_beats for when in moments)
            or any(span.unit.needs_beats for span in spans)
            or any(curve.needs_beats for curve in self.all_curves)
            or any(
                isinstance(curve.course, Expression) and curve.course.needs_sound
                for curve in self.all_curves
            )
        )
