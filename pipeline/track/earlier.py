"""Headers of earlier programs, as this one writes them."""

from collections.abc import Mapping
from typing import Any

from pipeline.options.course import Course
from pipeline.track.plain_values import CLASS, to_plain
from stages.flows import FLOWS
from stages.focus import FOCI
from stages.layouts import LAYOUTS
from stages.media.reading.read_options import ReadOptions
from warp_kernels.registry import Registry

UNKNOWN_THEN = {
    "focus": [{CLASS: "none"}],
    "read": to_plain(ReadOptions()),
    "course": to_plain(Course()),
}
"""What tracks were made with that did not know these options."""
WHOLE_JOB = "Job"
"""The class of options that held all of a run, looks and names of files among them."""
NO_MESH = frozenset(
    {"output", "device", "threads", "styles", "regions", "output_size", "scale", "blend", "smooth"}
    | {"encode", "track", "resume", "jobs"}
)
"""Fields of it that decide no mesh."""
MEMBERS: Mapping[str, Registry[Any]] = {"layout": LAYOUTS, "flow": FLOWS, "focus": FOCI}
"""Fields whose members were stored under the names of their classes."""


def up_to_date(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a track's header, as fields of `SolveOptions`.

    Args:
        options: Plain values, as the header holds them.
    """
    known = {**UNKNOWN_THEN, **options}
    if options.get(CLASS, WHOLE_JOB) == WHOLE_JOB:
        known = {k: v for k, v in known.items() if k not in NO_MESH} | {CLASS: "SolveOptions"}
    for name, registry in MEMBERS.items():
        if name in known:
            known[name] = _by_name(known[name], {c.__name__: n for n, c in registry.own.items()})
    return known


def _by_name(plain: Any, names: Mapping[str, str]) -> Any:
    """A member under its own name, or several."""
    if isinstance(plain, list):
        return [_by_name(entry, names) for entry in plain]
    if not (isinstance(plain, Mapping) and isinstance(plain.get(CLASS), str)):
        return plain
    return {**plain, CLASS: names.get(plain[CLASS], plain[CLASS])}
