"""Headers of earlier programs, as this one writes them."""

from collections.abc import Mapping
from typing import Any

from pipeline.track.plain_values import CLASS, to_plain
from stages.focus.none import NoFocus
from stages.media import ReadOptions

UNKNOWN_THEN = {"focus": [to_plain(NoFocus())], "read": to_plain(ReadOptions())}
"""What tracks were made with that did not know these options."""
WHOLE_JOB = "Job"
"""The class of options that held all of a run, looks and names of files among them."""
NO_MESH = frozenset(
    {"output", "device", "threads", "styles", "regions", "output_size", "scale", "blend", "smooth"}
    | {"encode", "track", "resume", "jobs"}
)
"""Fields of it that decide no mesh."""


def up_to_date(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a track's header, as fields of `SolveOptions`.

    Args:
        options: Plain values, as the header holds them.
    """
    known = {**UNKNOWN_THEN, **options}
    if options.get(CLASS, WHOLE_JOB) != WHOLE_JOB:
        return known
    return {k: v for k, v in known.items() if k not in NO_MESH} | {CLASS: "SolveOptions"}
