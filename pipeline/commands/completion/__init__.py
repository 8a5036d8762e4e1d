"""Completion of the command line for shells: `SHELLS` names them.

A script knows all that the parser knew when it was made, so nothing of the program runs while
somebody types. A new shell is a file with a function from commands to text, and a line here.
"""

from collections.abc import Callable, Mapping

from pipeline.commands.completion.bash import bash_script
from pipeline.commands.completion.fish import fish_script
from pipeline.commands.completion.words import CommandWords
from pipeline.commands.completion.zsh import zsh_script

SHELLS: dict[str, Callable[[Mapping[str, CommandWords]], str]] = {
    "bash": bash_script,
    "zsh": zsh_script,
    "fish": fish_script,
}
"""What writes the script for each shell."""
