"""What `help` and completion show of functions whose options are keywords."""

import inspect
import typing
from collections.abc import Callable
from typing import Any, TypeVar

from pipeline.library.keywords import KEYWORDS, PRESET, options_of
from pipeline.library.wording import in_keywords
from pipeline.options.command_line import Option

Function = TypeVar("Function", bound=Callable[..., Any])


def with_keywords(name: str) -> Callable[[Function], Function]:
    """Show every option of a function, with its default in its signature and its help in the text.

    Args:
        name: Its name in `KEYWORDS`.
    """

    def shown(function: Function) -> Function:
        """The same function, which says more about itself."""
        options = options_of(name)
        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        hints = typing.get_type_hints(KEYWORDS[name])
        more = [
            inspect.Parameter(
                keyword,
                inspect.Parameter.KEYWORD_ONLY,
                default=options[keyword].default if keyword in options else None,
                annotation=hints.get(keyword, Any),
            )
            for keyword in (*options, *(["preset"] if name in PRESET else []))
        ]
        described: Any = function
        described.__signature__ = signature.replace(parameters=[*own, *more])
        lines = [f"    {keyword}: {_help(option)}" for keyword, option in options.items()]
        described.__doc__ = "\n".join([inspect.getdoc(function) or "", "", "Options:", *lines])
        return function

    return shown


def _help(option: Option) -> str:
    """The help of an option; a switch is told as what it is when it is on."""
    return in_keywords(option.help.removeprefix("do not "))
