"""What is told of a file that is no TOML: where, and what to do, in words of our own."""

import re
import tomllib

from pipeline.timeline.written.place import Doubled, Place, doubled_in
from warp_kernels.errors import OptionError

_AT = re.compile(r"\s*\(at line (\d+), column (\d+)\)")
_DOUBLED = re.compile(r"Cannot (overwrite a value|declare \(.*\) twice)")


def fault_of(error: Exception, text: str, file: str) -> OptionError:
    """What is raised about a text that the parser refuses.

    Args:
        error: What the parser says.
        text: The file.
        file: Its name.
    """
    if isinstance(error, RecursionError):
        line, depth = _deepest(text)
        return Place(file, line).error(f"brackets stand {depth} deep; write lists in one pair")
    found = _AT.search(str(error))
    place = Place(file, int(found[1]), int(found[2])) if found else Place(file)
    if "(at end of document)" in str(error):
        place = Place(file, max(1, len(text.rstrip("\n").split("\n"))))
    if _DOUBLED.match(str(error)):
        double = doubled_in(text, file, place.line)
        if double is not None:
            return _of_double(double)
    reason = _AT.sub("", str(error)).replace(" (at end of document)", "")
    if not isinstance(error, tomllib.TOMLDecodeError):
        reason = reason.partition(";")[0]  # without Python's own remedy
    return place.error(
        f"no TOML ({reason[:1].lower()}{reason[1:]}); texts stand in quotes, lists in brackets"
    )


def _of_double(double: Doubled) -> OptionError:
    remedy = "put both in one" if double.name.startswith("[") else "leave one out"
    return double.place.error(
        f"{double.name} is given twice, first in line {double.first.line}; {remedy}"
    )


def _deepest(text: str) -> tuple[int, int]:
    """The line with the deepest brackets, from 1, and how deep they are there."""
    line, depth, found = 1, 0, (1, 0)
    for letter in text:
        line += letter == "\n"
        depth = max(depth + (letter in "[{") - (letter in "]}"), 0)
        found = max(found, (line, depth), key=lambda one: one[1])
    return found
