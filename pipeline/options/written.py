"""Values as they were written, for messages: in a TOML file and in a Python program."""

import json
import reprlib
from datetime import date
from textwrap import shorten

LONGEST = 60
"""Letters of a value in a message."""


def in_file(value: object) -> str:
    """A value behind its key, as a file has it but for tables, which have colons.

    Args:
        value: What was read of it.
    """
    text = str(value) if isinstance(value, date) else json.dumps(value, default=str)
    return f" = {shorten(text, LONGEST, placeholder='...')}"


def in_program(value: object) -> str:
    """A value behind its keyword.

    Args:
        value: What was given.
    """
    return f"={' '.join(reprlib.repr(value).split())}"
