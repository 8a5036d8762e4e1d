"""Values of options from a file or a program, read as the command line reads its texts."""

import reprlib
from argparse import ArgumentTypeError
from fractions import Fraction

from pipeline.options.command_line import Option
from warp_kernels.errors import OptionError


def option_value(option: Option, value: object, what: str, sign: str = " = ") -> object:
    """The value that the command line would give for the same.

    Args:
        option: What it is for.
        value: A number, a text, true or false, or a list of these if the option is repeatable.
        what: Where it stands, for messages.
        sign: What stands between that and the value in messages.

    Raises:
        OptionError: If the value is of another kind, or none that the option may have.
    """
    if option.is_switch:
        if not isinstance(value, bool):
            raise OptionError(f"{what}{sign}{value!r}: write true or false")
        return option.switched if value else not option.switched
    if option.is_repeatable:
        entries = value if isinstance(value, list | tuple) else [value]
        return [_single(option, entry, what, sign) for entry in entries]
    return _single(option, value, what, sign)


def _single(option: Option, value: object, what: str, sign: str) -> object:
    """One value, read by the same function as on the command line."""
    if isinstance(value, bool) or not isinstance(value, str | int | float | Fraction):
        shown = " ".join(reprlib.repr(value).split())
        form = f", as {option.metavar}" if option.metavar else ""
        raise OptionError(f"{what}{sign}{shown}: write a number or a text in quotes{form}")
    try:
        result = option.read(str(value))
    except ArgumentTypeError as error:
        raise OptionError(f"{what}: {error}") from error
    if option.choices is not None and result not in option.choices:
        raise OptionError(f"{what}{sign}{value!r}: choose from {', '.join(option.choices)}")
    return result
