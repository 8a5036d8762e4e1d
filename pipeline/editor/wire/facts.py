"""What a window is told when it opens: the job, its frames, the styles."""

from collections.abc import Sequence
from typing import Any

from pipeline.editor.bench.session import Session
from pipeline.options.members import parameters
from pipeline.options.values import kind_of
from stages.masks.area import Stroke
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

SAID = ("help", "unit", "range", "choices", "form")
"""What metadata say of a parameter."""


def facts_of(session: Session) -> dict[str, Any]:
    """All that does not change while a job is edited.

    Args:
        session: The job.
    """
    info = session.info
    return {
        "name": session.options.source.name,
        "source": str(session.options.source),
        "track": str(session.path),
        "stem": session.path.stem,
        "width": info.width,
        "height": info.height,
        "frames": session.film.frames,
        "shots": [[shots.first, shots.last] for shots in session.film.shots],
        "rate": None if info.average_rate is None else float(info.average_rate),
        "model": session.easel.model.name,
        "styles": style_facts(),
        "course": _course(session),
    }


def _course(session: Session) -> dict[str, float]:
    """What the optimiser aimed at when the clip was solved."""
    solved = session.options.triangulate
    return {
        "triangles": solved.refine.triangles,
        "error": solved.refine.error or 0.0,
        "regularity": solved.optimize.regularity,
        "trust_region": solved.optimize.trust_region,
    }


def style_facts() -> dict[str, Any]:
    """The styles that can be used, each with what it says of itself and of its parameters."""
    found: dict[str, Any] = {}
    for name in STYLES:
        try:
            cls: Any = STYLES[name]
        except OptionError:
            continue  # of a package that does not work here
        summary = (cls.__doc__ or "").strip().partition("\n")[0]
        told = [_parameter(field) for field in parameters(cls)]
        found[name] = {"summary": summary, "parameters": told}
    return found


def strokes_told(strokes: Sequence[Stroke]) -> list[dict[str, Any]]:
    """Strokes as a window draws them.

    Args:
        strokes: Those of one frame.
    """
    return [
        {
            "at": None if stroke.area.polygon else list(stroke.area.at),
            "radius": stroke.area.radius,
            "polygon": list(stroke.area.polygon),
            "strength": stroke.strength,
        }
        for stroke in strokes
    ]


def _parameter(field: Any) -> dict[str, Any]:
    """A parameter: its name, kind, default, and what its metadata say."""
    said = {
        key: field.metadata[key]
        for key in ("help", "unit", "range", "choices")
        if key in field.metadata
    }
    default = field.default if isinstance(field.default, str | int | float | bool) else None
    return {"name": field.name, "kind": kind_of(field), "default": default, **said}
