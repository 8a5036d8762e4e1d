"""Where errors count more: `FOCI` names the members for the command line.

A focus is a frozen dataclass of parameters, `strength` among them, whose methods import what they
need: the help reads the parameters of all. A new one is a file and a line here, or a package of its
own. What it does is one of these:

- `glance(before, frame)`: a map of what counts in one picture; over time it is smoothed by others.
- `Faces` and `Auto` search for faces, which are followed over time.
- `Picture` has a picture, or one for each frame, that says it.
"""

from collections.abc import Iterable
from dataclasses import fields
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from stages.focus.faces import Auto
from stages.focus.none import NoFocus
from stages.focus.picture import Picture
from warp_kernels.errors import OptionError
from warp_kernels.registry import Registry

if TYPE_CHECKING:
    import numpy as np

    from stages.frame import Frame


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

    def glance(self, before: "Frame | None", frame: "Frame") -> "np.ndarray":
        """What counts in a picture, [h, w] float32 of any size, 0 to 1.

        `before` is the frame before in the same shot, or None.
        """
        ...


FOCI: Registry[Focus] = Registry(
    "foci",
    {
        "auto": "stages.focus.faces:Auto",
        "none": "stages.focus.none:NoFocus",
        "faces": "stages.focus.faces:Faces",
        "saliency": "stages.focus.saliency:Saliency",
        "motion": "stages.focus.motion:Motion",
        "center": "stages.focus.center:Center",
        "picture": "stages.focus.picture:Picture",
    },
    method="glance",
)


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
    texts = []
    for member in members:
        usual = {field.name: field.default for field in fields(member)}  # type: ignore[arg-type]
        told = [f"{n}={getattr(member, n)}" for n in usual if getattr(member, n) != usual[n]]
        texts.append(":".join(filter(None, [FOCI.name_of(type(member)), ",".join(told)])))
    return " ".join(texts) or "none"
