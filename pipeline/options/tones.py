"""Grades and palettes as users write them: `saturation=0.5`, `#123,#fa0:mode=nearest`."""

import os
import re
from pathlib import Path

from pipeline.options.members import parse_parameters
from pipeline.options.nearest import nearest
from stages.toning.grade import Grade
from stages.toning.palette import MOST_COLORS, PALETTES, Color, Palette
from stages.toning.swatches import ENDINGS, UNORDERED, read_swatches
from warp_kernels.errors import OptionError
from warp_kernels.styles.color import parse_color

COUNT = 5
"""Colours that are taken of a picture."""
_PARAMETERS = re.compile(
    r"(.*?)(?::((?:(?:mode|amount|hold|count)=|map\b|match\b|nearest\b)[^:]*))?", re.DOTALL
)


def parse_grade(text: str) -> Grade:
    """Read `KEY=VALUE,...`.

    Raises:
        OptionError: If a parameter is none, or out of its range.
    """
    if "=" not in text:
        raise OptionError(
            f"--grade {text}: write KEY=VALUE,..., such as exposure=0.5,saturation=0.8"
        )
    kinds = dict.fromkeys(Grade.__dataclass_fields__, "float")
    values = parse_parameters("--grade", text, "a grade", text, kinds)
    try:
        return Grade(**values)
    except OptionError as error:
        raise OptionError(f"--grade {text}: {error}") from error


def parse_palette(text: str) -> Palette:
    """Read `COLORS|FILE|NAME`, followed by `:KEY=VALUE,...` if anything is to be said.

    Raises:
        OptionError: If there are no colours, or a parameter is none.
        MediaError: If the file holds no palette.
    """
    match = _PARAMETERS.fullmatch(text)
    assert match is not None
    what, rest = (text, "") if os.path.isfile(text) else (match[1], match[2] or "")
    kinds = {"mode": "str", "amount": "float", "hold": "float", "count": "int"}
    values = parse_parameters("--palette", text, "a palette", rest, kinds)
    count = values.pop("count", None)
    if count is not None and not 2 <= count <= MOST_COLORS:
        raise OptionError(f"--palette {text}: count={count}: 2 to {MOST_COLORS} colours")
    try:
        colors, is_ordered = _colors(what, count)
        if not is_ordered:
            values.setdefault("mode", "match")
        return Palette(colors, **values)
    except OptionError as error:
        raise OptionError(f"--palette {text}: {error}") from error


def _colors(what: str, count: int | None) -> tuple[tuple[Color, ...], bool]:
    """The colours of a file, of a name, or those that are listed, and whether in an order."""
    path = Path(what)
    ending = path.suffix.lower()
    if os.path.isfile(path) and ending not in ENDINGS:
        from stages.toning.picture_colors import colors_of_picture

        return colors_of_picture(what, count or COUNT), False
    if count is not None:
        raise OptionError("count is for the colours of a picture; leave it out")
    if ending in ENDINGS:
        return read_swatches(path), ending not in UNORDERED
    if what in PALETTES:
        return tuple(parse_color(color) for color in PALETTES[what]), True
    words = [word for word in re.split(r"[,;\s]+", what.strip()) if word]
    if len(words) == 1 and _is_color(words[0]):
        raise OptionError(f"one colour is no palette; write {words[0]},white, or more of them")
    if len(words) < 2:
        raise OptionError(f"neither colours nor a file: {_remedy(what)}")
    return tuple(parse_color(word) for word in words), True


def _is_color(word: str) -> bool:
    """Whether a word is a colour."""
    try:
        parse_color(word)
    except OptionError:
        return False
    return True


def _remedy(what: str) -> str:
    """What to write instead of what is no palette."""
    hint = nearest(what, PALETTES, "take")
    return f"{hint}, or #123,#fa0,white, or a file that is there"
