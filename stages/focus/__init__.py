"""Where errors count more: `FOCI` names the members for the command line.

A focus is a frozen dataclass of parameters, `strength` among them; a new one is a file and a line
here. What it does is one of these:

- `glance(before, frame)`: a map of what counts in one picture; over time it is smoothed by others.
- `Faces` and `Auto` search for faces, which are followed over time.
- `Picture` has a picture, or one for each frame, that says it.
"""

from collections.abc import Iterable
from dataclasses import fields
from typing import Protocol, runtime_checkable

import numpy as np

from stages.focus.center import Center
from stages.focus.faces import Auto, Faces
from stages.focus.motion import Motion
from stages.focus.none import NoFocus
from stages.focus.picture import Picture
from stages.focus.saliency import Saliency
from stages.frame import Frame
from warp_kernels.errors import OptionError


class Focus(Protocol):
    """What every member of `FOCI` has."""

    @property
    def strength(self) -> float:
        """How much it adds, 0 for nothing, 1 for what is usual."""
        ...


@runtime_checkable
class Glance(Protocol):
    """A member that makes a map of every picture."""

    @property
    def strength(self) -> float:
        """How much it adds, 0 for nothing, 1 for what is usual."""
        ...

    def glance(self, before: Frame | None, frame: Frame) -> np.ndarray:
        """What counts in a picture, [h, w] float32 of any size, 0 to 1.

        `before` is the frame before in the same shot, or None.
        """
        ...


FOCI: dict[str, type[Focus]] = {
    "auto": Auto,
    "none": NoFocus,
    "faces": Faces,
    "saliency": Saliency,
    "motion": Motion,
    "center": Center,
    "picture": Picture,
}


def resolved(given: Iterable[Focus], weights: str | None) -> tuple[Focus, ...]:
    """The members that are at work.

    Args:
        given: Those that the user named; nobody for `auto`, but for nothing beside a map.
        weights: The map of `--weights`, which counts as `picture:MAP`.

    Raises:
        OptionError: If `none` has company.
    """
    members = tuple(given)
    if not members:
        members = (Auto(),) if weights is None else ()
    if len(members) > 1 and any(isinstance(member, NoFocus) for member in members):
        raise OptionError("--focus none: goes with no other; leave it out or leave the others out")
    if weights is not None:
        members += (Picture(weights),)
    return tuple(m for m in members if not isinstance(m, NoFocus) and m.strength > 0)


def spelled(members: Iterable[Focus]) -> str:
    """Members as `--focus` takes them, with what is not usual; `none` for nobody.

    Args:
        members: The members.
    """
    names = {cls: name for name, cls in FOCI.items()}
    texts = []
    for member in members:
        usual = {field.name: field.default for field in fields(member)}  # type: ignore[arg-type]
        told = [f"{n}={getattr(member, n)}" for n in usual if getattr(member, n) != usual[n]]
        texts.append(":".join(filter(None, [names[type(member)], ",".join(told)])))
    return " ".join(texts) or "none"
