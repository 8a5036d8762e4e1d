"""The one tree of errors that a user may see; the command line prints each as a single line.

    TrimotionError            exit 1
    +-- OptionError           exit 2   an option or argument that cannot be met
    |   +-- EditError         exit 2   an edit by hand that cannot be made
    +-- MediaError            exit 3   an input that cannot be read
    |   +-- OutputError       exit 4   an output that cannot be written
    +-- TrackError            exit 3   a mesh track that cannot be used
    +-- ShortMemoryError      exit 1   memory has run out

It lives in the lowest package because every package raises some of it and imports go downwards.
"""

from pathlib import Path


class TrimotionError(Exception):
    """A failure that is the user's to mend: the message says what, the value and the remedy."""

    exit_code = 1


class OptionError(TrimotionError):
    """An option whose value cannot be met."""

    exit_code = 2


class EditError(OptionError):
    """An edit by hand that cannot be made; nothing has changed."""


class MediaError(TrimotionError):
    """An input file that cannot be read.

    Args:
        path: The file, as the user wrote it; it starts the message.
        problem: What is wrong with it, with the value found.
        remedy: What to do about it.
    """

    exit_code = 3

    def __init__(self, path: str | Path, problem: str, remedy: str) -> None:
        super().__init__(f"{path}: {problem}; {remedy}")
        self.path = Path(path)
        self.problem = problem
        self.remedy = remedy


class OutputError(MediaError):
    """An output file that cannot be written."""

    exit_code = 4


class TrackError(TrimotionError):
    """A mesh track that cannot be used."""

    exit_code = 3


class ShortMemoryError(TrimotionError):
    """Memory has run out, whatever a library said of it."""
