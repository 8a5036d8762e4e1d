"""What to type to make the same without the editor."""

import shlex
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pipeline.options.command_line import Option, job_options
from pipeline.options.solve_options import SolveOptions
from pipeline.track.plain_values import CLASS, to_plain

WRITTEN_APART = frozenset({"source", "frame_range", "edits", "seam", "course"})
"""Fields that no flag of their own stands for, or that are written in another way."""


def solve_line(track: Path, options: SolveOptions) -> str:
    """The command that makes the edited film's track from its source.

    Args:
        track: The track that holds the edits.
        options: How it was solved.
    """
    again = track.with_name(f"{track.stem}.edited{track.suffix}")
    words = ["trimotion", "solve", _named(options.source), *solve_flags(options)]
    return shlex.join([*words, "--edits", _named(track), "-o", _named(again)])


def render_line(track: Path, output: Path, styles: Sequence[str]) -> str:
    """The command that draws a track.

    Args:
        track: The track.
        output: What is written.
        styles: The look, bottom to top, as on the command line.
    """
    looks = [word for style in styles for word in ("--style", style)]
    return shlex.join(["trimotion", "render", _named(track), "-o", _named(output), *looks])


def solve_flags(options: SolveOptions) -> list[str]:
    """The flags that were given, or would have to be.

    Args:
        options: How a track was solved.
    """
    known = {option.dest: option for option in job_options()}
    usual = to_plain(SolveOptions(options.source))
    flags = list(_flags(to_plain(options), usual, known))
    wanted = options.frame_range
    if wanted.is_whole:
        return flags
    last = "" if wanted.last is None else wanted.last
    step = "" if wanted.step == 1 else f"x{wanted.step}"
    flags += ["--frames", f"{wanted.first}-{last}{step}"]
    for name, time in (("--start", wanted.start_time), ("--end", wanted.end_time)):
        flags += [] if time is None else [name, f"{float(time):.9g}"]
    return flags


def _named(path: Path) -> str:
    """A file as one would type its name here."""
    whole, here = path.absolute(), Path.cwd()
    return str(whole.relative_to(here)) if whole.is_relative_to(here) else str(path)


def _flags(
    given: Mapping[str, Any], usual: Mapping[str, Any], known: Mapping[str, Option]
) -> Iterator[str]:
    """Flags for what differs from the default, part by part."""
    for name, value in given.items():
        if name in WRITTEN_APART or value == usual.get(name):
            continue
        option = known.get(name)
        if option is None:
            if isinstance(value, Mapping):
                yield from _flags(value, usual.get(name, {}), known)
        elif option.is_switch:
            yield f"--{option.flag}"
        else:
            for entry in value if option.is_repeatable else [value]:
                yield from (f"--{option.flag}", _written(entry))


def _written(value: Any) -> str:
    """A value as it is typed; a member of a registry with its parameters."""
    if isinstance(value, Mapping) and CLASS in value:
        pairs = (f"{k}={_written(v)}" for k, v in value.items() if k != CLASS and v is not None)
        return ":".join(filter(None, (str(value[CLASS]), ",".join(pairs))))
    return f"{value:.17g}" if isinstance(value, float) else str(value)
