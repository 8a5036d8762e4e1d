"""Several inputs, or what a folder holds: one output for each, in one folder."""

import os
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pipeline.options.output_name import FILMS, OTHER_FILMS, OTHER_STILLS, STILLS, output_in
from warp_kernels.errors import MediaError, OptionError

TRACKS = frozenset({".mtrk"})
"""Endings of mesh tracks."""
ENDINGS = {"render": TRACKS}
"""Endings of the files of a folder that a command takes; films and pictures for the others."""
MADE = {"solve": ".mtrk"}
"""Ending of outputs, where it does not follow from the input's."""
MANY_NUMBERED = 8
"""So many stills with successive numbers may be a clip, which their user may have meant."""
MOST_NAMED = 3
"""Files that are named in a note."""

_NUMBERED = re.compile(r"(.*?)(\d+)(\D*)")


@dataclass(frozen=True)
class Item:
    """One input and what becomes of it."""

    source: str
    """The input."""
    output: Path
    """The output, in the folder."""


@dataclass(frozen=True)
class Batch:
    """What is done one after the other."""

    items: tuple[Item, ...]
    """The inputs, in order, and their outputs."""
    folder: Path
    """Where outputs go."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""


def batch_of(command: str, inputs: Sequence[str], output: str) -> Batch | None:
    """Plan several runs.

    Args:
        command: What is done with each: `animate`, `solve` or `render`.
        inputs: What the user named: files, patterns and folders.
        output: Where to.

    Returns:
        None if one file or pattern is named.

    Raises:
        MediaError: If a folder holds nothing that the command takes.
        OptionError: If the output is no folder, or two inputs would have the same one.
    """
    if len(inputs) == 1 and not os.path.isdir(inputs[0]):
        return None
    if "-" in inputs:
        raise OptionError("-: a pipe is an input of its own; name files and folders alone")
    notes: list[str] = []
    sources = [source for name in inputs for source in _files_of(command, name, notes)]
    folder = Path(output)
    if not (os.path.isdir(folder) or output.endswith(("/", os.sep))):
        several = (
            f"{inputs[0]} is a folder" if len(inputs) == 1 else f"there are {len(inputs)} inputs"
        )
        named = "out/" if folder.suffix else f"{output}/"
        raise OptionError(f"-o {output}: {several}; name a folder for the outputs, such as {named}")
    items = tuple(
        Item(source, output_in(f"{output}/", source, _made(command, source))) for source in sources
    )
    _refuse_collisions(items)
    return Batch(items, folder, tuple(notes))


def _made(command: str, source: str) -> str | None:
    """Ending of an output, where it does not follow from the input's."""
    if command != "render":
        return MADE.get(command)
    from pipeline.track.kind import drawn_ending

    return drawn_ending(Path(source))


def _files_of(command: str, name: str, notes: list[str]) -> Iterator[str]:
    """The input itself, or the files of a folder that the command takes, by name."""
    if not os.path.isdir(name):
        yield name
        return
    wanted = ENDINGS.get(command, STILLS | FILMS | OTHER_STILLS | OTHER_FILMS)
    files = [path for path in Path(name).iterdir() if not path.name.startswith(".")]
    files = sorted((path for path in files if path.is_file()), key=_by_number)
    taken = [path for path in files if path.suffix.lower() in wanted]
    if not taken:
        kind = "mesh track" if command == "render" else "film or picture"
        raise MediaError(name, f"holds no {kind}", "name another folder, or files")
    left = [path.name for path in files if path not in taken]
    if left:
        notes.append(f"{name}: left out: {_named(left)}")
    notes.extend(_clips_among(taken))
    yield from map(str, taken)


def _by_number(path: Path) -> list[tuple[int, str]]:
    """Names in the order in which people count: a2 before a10."""
    parts = re.findall(r"\d+|\D+", path.name.lower())
    return [(int(part), "") if part.isdecimal() else (0, part) for part in parts]


def _clips_among(files: Sequence[Path]) -> Iterator[str]:
    """What to say about stills that look like the frames of a clip."""
    numbers: dict[tuple[Path, str, str, int], list[int]] = {}
    for path in files:
        match = _NUMBERED.fullmatch(path.name)
        if match and path.suffix.lower() in STILLS | OTHER_STILLS:
            key = (path.parent, match[1], match[3], len(match[2]))
            numbers.setdefault(key, []).append(int(match[2]))
    for (folder, before, after, digits), found in numbers.items():
        if len(found) >= MANY_NUMBERED and max(found) - min(found) == len(found) - 1:
            field = "#" * digits if digits > 1 else "%01d"
            pattern = folder / f"{before}{field}{after}"
            yield (
                f"{len(found)} numbered stills become a picture each; as a clip they are {pattern}"
            )


def _refuse_collisions(items: Sequence[Item]) -> None:
    """Before any work is done: the second would replace the first."""
    counts = Counter(str(item.output).casefold() for item in items)
    for item in items:
        if counts[str(item.output).casefold()] > 1:
            same = [
                other.source
                for other in items
                if str(other.output).casefold() == str(item.output).casefold()
            ]
            if len({os.path.realpath(source) for source in same}) == 1:
                raise OptionError(f"{same[0]}: is named {len(same)} times; name it once")
            raise OptionError(
                f"{_named(same)}: all would become {item.output}; give each a folder of its own"
            )


def _named(names: Sequence[str]) -> str:
    """Some names, and how many more there are."""
    shown = ", ".join(names[:MOST_NAMED])
    more = len(names) - MOST_NAMED
    return shown if more <= 0 else f"{shown} and {more} more"
