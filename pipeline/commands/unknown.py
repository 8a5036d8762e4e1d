"""What to say about words of the command line that mean nothing."""

import difflib
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from pipeline.options.command_line import COMMAND_OPTIONS, job_options
from pipeline.options.nearest import nearest

SEVERAL = ("animate", "solve", "render")
"""Commands that take several inputs."""

ALLOW_URL = "--allow-url"
"""An option of commands that read a source once: what is read again must stay where it is."""


def no_command(word: str, known: Iterable[str]) -> str:
    """What to say about a first word that is no command."""
    if Path(word).suffix or os.path.exists(word):
        return f"{word!r}: a command comes first, as in trimotion animate {word} -o OUTPUT"
    return f"{word!r}: no such command; {nearest(word, known)}"


def unknown_arguments(arguments: Sequence[str], known: Sequence[str], command: str) -> str:
    """What to say about arguments that no option takes."""
    first = arguments[0].split("=")[0]
    if not first.startswith("-"):
        apart = "; several inputs stand side by side" if command in SEVERAL else ""
        return f"{arguments[0]!r}: unknown argument{apart}"
    if first == ALLOW_URL:
        return f"{first}: {command} fetches nothing; download the file and give its name"
    named = [option for option in job_options() if option.flag == first.lstrip("-")]
    owners = [name for name, has in COMMAND_OPTIONS.items() if any(map(has, named))]
    # what preview and timeline have is that of animate, and what plan and edit have that of solve
    owners = [name for name in owners if name not in ("preview", "timeline", "plan", "edit")]
    if owners:
        some = ", ".join(owners[:-1])
        owned = f"{some} and {owners[-1]}" if some else owners[-1]
        return f"{first}: is an option of {owned}, not of {command}{_why(command, first)}"
    begun = [option for option in known if option.startswith(first)]
    similar = begun or difflib.get_close_matches(first, known, n=1)
    hint = f"; did you mean {similar[0]}?" if similar else ""
    return f"{arguments[0]!r}: unknown option{hint}"


def _why(command: str, flag: str) -> str:
    """What to do with an option that others have and a command has not."""
    if command == "render":
        return f", which draws what was solved; solve again with {flag}"
    if command == "solve":
        return f", which draws nothing; give {flag} to render"
    return ""
