"""Text of strangers for terminals and logs: nothing in it is a command, no word is endless."""

LONGEST = 300
"""Letters of a word that are shown; a name of a file may have as many."""
_HEAD, _TAIL = 200, 60
"""What is shown of a longer one."""


def printable(text: str) -> str:
    """Text in which letters that could command a terminal are written out, such as `\\x1b`.

    Args:
        text: What is to be shown; lines may end in it.
    """
    if text.isprintable():
        return text
    return "".join(one if one.isprintable() or one == "\n" else _spelled(one) for one in text)


def one_line(text: str) -> str:
    """A message as one line: words apart by single spaces, endless ones cut in the middle.

    Args:
        text: The message.
    """
    return printable(" ".join(map(_cut, text.split())))


def _spelled(letter: str) -> str:
    return letter.encode("unicode_escape").decode()


def _cut(word: str) -> str:
    return word if len(word) <= LONGEST else f"{word[:_HEAD]}...{word[-_TAIL:]}"
