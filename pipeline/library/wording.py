"""Messages for programs: `triangles=0: ...` where the command line says `--triangles 0: ...`."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from pipeline.library.keywords import keyword_of
from pipeline.options.command_line import Option, job_options
from warp_kernels.errors import MediaError, TrimotionError

_FLAG = re.compile(r"--(?P<flag>[a-z]+(?:-[a-z]+)*)(?:(?P<gap> )(?=(?P<next>\S+)))?")
_LIKE_A_VALUE = re.compile(r"[0-9A-Z]")
"""In sentences a value is a number, a name or a form such as A-B; other words are not."""
_SURPLUS = " --debug"
"""A flag that has no keyword: Python shows where an error arose."""


@contextmanager
def worded() -> Iterator[None]:
    """Let errors that pass speak of keywords; also a decorator."""
    try:
        yield
    except TrimotionError as error:
        error.args = tuple(in_keywords(str(part)) for part in error.args)
        if isinstance(error, MediaError):
            error.problem = in_keywords(error.problem)
            error.remedy = in_keywords(error.remedy)
        raise


def in_keywords(text: str) -> str:
    """A message with keywords in place of flags.

    Args:
        text: A message of the command line.
    """
    text = text.replace(_SURPLUS, "")
    return _FLAG.sub(_reworded, text)


def _reworded(match: re.Match[str]) -> str:
    """A flag as a keyword, joined with its value if that follows."""
    gap, following = match["gap"] or "", match["next"] or ""
    option = _flags().get(match["flag"])
    if option is not None and option.is_switch:
        return f"{option.dest}={not option.default}{gap}"
    keyword = match["flag"].replace("-", "_") if option is None else keyword_of(option)
    # a message that begins with a flag has a colon behind its value
    leads = match.start() == 0 and ": " in match.string
    has_value = gap and not following.startswith("--")
    if has_value and (leads or _LIKE_A_VALUE.search(following)):
        return f"{keyword}="
    return f"{keyword}{gap}"


@cache
def _flags() -> dict[str, Option]:
    return {option.flag: option for option in job_options()}
