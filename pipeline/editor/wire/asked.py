"""What a window asks for: one JSON object a message, checked before anything is done."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from warp_kernels.errors import TrimotionError

MOST_BYTES = 1 << 20
"""Longest message: a region of ten thousand corners fits in."""
MOST_VALUES = 50_000
"""Values of a message."""


class AskError(TrimotionError):
    """A message that cannot be understood."""

    exit_code = 2


@dataclass(frozen=True)
class Asked:
    """A message of a window."""

    number: int
    """Its number, which the answer bears."""
    what: str
    """What is asked for."""
    values: Mapping[str, Any]
    """What goes with it."""

    def text(self, name: str, default: str | None = None) -> str:
        """A text.

        Raises:
            AskError: If it is none.
        """
        return str(self._of(name, str, "text", default))

    def whole(self, name: str, default: int | None = None) -> int:
        """A whole number from 0.

        Raises:
            AskError: If it is none.
        """
        number = self._of(name, int, "whole number", default)
        if not 0 <= number < 1 << 53:
            raise AskError(f"{self.what}: {name} {number} is no number that counts something")
        return int(number)

    def real(self, name: str, default: float | None = None) -> float:
        """A number.

        Raises:
            AskError: If it is none.
        """
        return float(self._of(name, (int, float), "number", default))

    def items(self, name: str, default: list[Any] | None = None) -> list[Any]:
        """A list.

        Raises:
            AskError: If it is none.
        """
        return list(self._of(name, list, "list", default))

    def _of(self, name: str, kind: Any, called: str, default: Any) -> Any:
        value = self.values.get(name, default)
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise AskError(f"{self.what}: it needs {name}, a {called}")
        return value


def read_asked(text: str) -> Asked:
    """Understand a message.

    Args:
        text: What came.

    Raises:
        AskError: If it is no message of a window.
    """
    if len(text) > MOST_BYTES or text.count(",") + text.count("[") > MOST_VALUES:
        raise AskError(f"a message of more than {MOST_BYTES} letters or {MOST_VALUES} values")
    try:
        found = json.loads(text, parse_constant=_refused)
    except (ValueError, RecursionError) as error:
        raise AskError("a message that is not JSON") from error
    if not isinstance(found, dict):
        raise AskError("a message that is no object")
    number, what = found.pop("number", None), found.pop("ask", None)
    if type(number) is not int or not isinstance(what, str):
        raise AskError("a message without a number or an ask")
    return Asked(number, what, found)


def _refused(name: str) -> None:
    raise ValueError(f"{name} is no number")
