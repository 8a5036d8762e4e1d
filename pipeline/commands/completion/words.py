"""What may be written on the command line, as the parser has it."""

import argparse
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pipeline.options.command_line import job_options
from pipeline.options.presets import shipped_presets
from pipeline.timeline.timeline import shipped_timelines
from stages.look.output_size import NAMED_SIZES
from stages.media.writing.codecs import CARD_CODECS, VIDEO_CODECS
from stages.toning.grade import Grade
from stages.toning.palette import PALETTES
from warp_kernels.styles.color_names import COLOR_NAMES

MOST_LETTERS = 70
"""Letters of a description."""

LISTED: dict[str, Iterable[str]] = {
    "preset": shipped_presets(),
    "timeline": shipped_timelines(),
    "output_size": NAMED_SIZES,
    "codec": [*VIDEO_CODECS, *CARD_CODECS],
    "background": COLOR_NAMES,
    "palette": PALETTES,
    "grade": tuple(f"{name}=" for name in Grade.__dataclass_fields__),
}
"""Names that are values of an option, beside others."""

_FILE = re.compile(r"FILE|INPUT|OUTPUT|SOURCE|PICTURE|MAP|MASK|\.mtrk|\.png")
_WORD = re.compile(r"[a-z0-9]+")


@dataclass(frozen=True)
class OptionWords:
    """One option."""

    flags: tuple[str, ...]
    """Its names, such as `-o` and `--output`."""
    help: str
    """What it does, in a few words."""
    takes_value: bool
    """Whether a value follows."""
    values: tuple[str, ...]
    """Values that can be listed."""
    takes_file: bool
    """Whether the name of a file may follow."""


@dataclass(frozen=True)
class CommandWords:
    """One command."""

    help: str
    """What it does, in a few words."""
    options: tuple[OptionWords, ...]
    """Its options."""
    values: tuple[str, ...]
    """Arguments that can be listed."""
    takes_file: bool
    """Whether names of files are arguments."""


def words_of(
    commands: Mapping[str, argparse.ArgumentParser], listed: Mapping[str, tuple[str, ...]]
) -> dict[str, CommandWords]:
    """Collect what may be written.

    Args:
        commands: Parsers by the names of their commands.
        listed: Arguments of commands that can be listed, which the parser does not know.
    """
    return {name: _command(parser, listed.get(name, ())) for name, parser in commands.items()}


def _command(parser: argparse.ArgumentParser, listed: tuple[str, ...]) -> CommandWords:
    actions = parser._actions
    named = [action for action in actions if action.option_strings]
    others = [action for action in actions if not action.option_strings]
    values = [*listed, *(str(value) for action in others for value in action.choices or ())]
    return CommandWords(
        help=_short(parser.description),
        options=tuple(_option(action) for action in named),
        values=tuple(values),
        takes_file=any(_takes_file(action) for action in others),
    )


def _option(action: argparse.Action) -> OptionWords:
    return OptionWords(
        flags=tuple(action.option_strings),
        help=_short((action.help or "").replace("%%", "%")),
        takes_value=action.nargs != 0,
        values=tuple(dict.fromkeys(_values(action))) if action.nargs != 0 else (),
        takes_file=action.nargs != 0 and _takes_file(action),
    )


def _values(action: argparse.Action) -> Iterator[str]:
    """Values of an option that can be listed: choices, members of its family, names."""
    yield from LISTED.get(action.dest, ())
    family = {option.dest: option.registry for option in job_options()}.get(action.dest)
    if family is not None:
        yield from family
    elif action.choices is not None:
        yield from map(str, action.choices)
    elif isinstance(action.metavar, str) and "|" in action.metavar:
        yield from filter(_WORD.fullmatch, action.metavar.split("|"))


def _takes_file(action: argparse.Action) -> bool:
    return isinstance(action.metavar, str) and bool(_FILE.search(action.metavar))


def _short(text: str | None) -> str:
    """The beginning of a text: menus of shells are narrow."""
    first = re.split(r"[;:(]", " ".join((text or "").split()), maxsplit=1)[0].strip()
    if len(first) > MOST_LETTERS:
        first = first[:MOST_LETTERS].rsplit(" ", 1)[0]
    return first.rstrip(".,")
