"""Text files as editors of all systems write them."""

import codecs
from pathlib import Path

_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),  # begins like the mark of UTF-16 and must come before it
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""Byte order marks and the encodings that they tell of."""
MOST_BYTES = 256 * 2**20
"""Larger files are no texts that people wrote."""


def read_text(path: Path) -> str:
    """Read a text in UTF-8 or UTF-16, with or without a byte order mark; lines end in a newline.

    Args:
        path: The file.

    Raises:
        OSError: If it cannot be read.
        ValueError: If it is in another encoding, or too large.
    """
    return text_of(bounded_bytes(path))


def reason_of(error: OSError | ValueError) -> str:
    """Why `read_text` failed, in words for whoever wrote the name of the file.

    Args:
        error: What it raised.
    """
    if isinstance(error, UnicodeDecodeError):
        return "it is no text"
    return str(getattr(error, "strerror", None) or error).lower()


def bounded_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """What a file holds, read once: it may be a pipe or a device that never ends.

    Args:
        path: The file.
        most: How many bytes a text may have.

    Raises:
        OSError: If it cannot be read.
        ValueError: If it is larger.
    """
    with path.open("rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ValueError(f"it is larger than {most >> 20} MiB")
    return content


def text_of(content: bytes) -> str:
    """The text in a file of UTF-8 or UTF-16, as `read_text` gives it.

    Args:
        content: What the file holds.

    Raises:
        UnicodeDecodeError: If it is in another encoding.
    """
    text = content.decode(_encoding_of(content))
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _encoding_of(content: bytes) -> str:
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    if content[1:2] == b"\0":  # the first letter of a text that we read is a plain one
        return "utf-16-le"
    return "utf-16-be" if content[:1] == b"\0" else "utf-8"
