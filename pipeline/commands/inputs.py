"""Names on the command line: pipes, addresses, and which input is worked on."""

import argparse
from collections.abc import Sequence

PIPE = "-"
"""How a user names a pipe; `-.gif` and the like choose the format of an output."""


def take(arguments: argparse.Namespace, name: str) -> None:
    """Make one of several inputs the one that is worked on.

    Args:
        arguments: What the user gave; changed.
        name: The input.
    """
    setattr(arguments, "track" if arguments.command == "render" else "source", name)


def inputs_of(arguments: argparse.Namespace) -> tuple[str, ...]:
    """Where the names of inputs stand that may be pipes.

    Args:
        arguments: What the user gave.
    """
    # Of the other commands the track is an output, or one of two files.
    return ("source", "file", *(("track",) if arguments.command == "render" else ()))


def joined(arguments: Sequence[str]) -> list[str]:
    """Arguments in which `-o -.png` is one word: apart from it the second looks like an option.

    Args:
        arguments: As the shell gives them.
    """
    words: list[str] = []
    for word in arguments:
        if words and words[-1] in ("-o", "--output") and is_pipe(word):
            words[-1] += word if words[-1] == "-o" else f"={word}"
        else:
            words.append(word)
    return words


def is_pipe(output: str) -> bool:
    """Whether a name means standard output, with or without a format.

    Args:
        output: The name.
    """
    return output == PIPE or (output.startswith("-.") and "/" not in output)


def add_allow_url(parser: argparse.ArgumentParser, metavar: str = "INPUT") -> None:
    """Give a parser the option.

    Args:
        parser: That of a command.
        metavar: What its source is called.
    """
    parser.add_argument(
        "--allow-url",
        action="store_true",
        help=f"{metavar} may be an http or https address; it is fetched whole, to a temporary file",
    )
