"""Completion for fish."""

from collections.abc import Iterator, Mapping

from pipeline.commands.completion.words import CommandWords, OptionWords

_HEAD = """\
# Completion of trimotion for fish:
#   trimotion completion fish > ~/.config/fish/completions/trimotion.fish
complete -c trimotion -f
complete -c trimotion -n __fish_use_subcommand -s h -l help -d help
complete -c trimotion -n __fish_use_subcommand -s V -l version -d 'the version'
complete -c trimotion -n __fish_use_subcommand -l debug -d 'show where an error arose'
"""


def fish_script(commands: Mapping[str, CommandWords]) -> str:
    """Write the script.

    Args:
        commands: What may be written, by command.
    """
    return _HEAD + "\n".join(_lines(commands)) + "\n"


def _lines(commands: Mapping[str, CommandWords]) -> Iterator[str]:
    for name, command in commands.items():
        about = _quoted(command.help)
        yield f"complete -c trimotion -n __fish_use_subcommand -a {name} -d {about}"
        within = f"complete -c trimotion -n '__fish_seen_subcommand_from {name}'"
        if command.values:
            yield f"{within} -a {_quoted(' '.join(command.values))}"
        if command.takes_file:
            yield f"{within} -F"
        for option in command.options:
            yield f"{within} {_option(option)}"


def _option(option: OptionWords) -> str:
    """Its names, what may follow, and what it does."""
    parts = [
        f"-l {flag[2:]}" if flag.startswith("--") else f"-s {flag[1:]}" for flag in option.flags
    ]
    if option.takes_value:
        parts.append("-r -F" if option.takes_file else "-x")
    if option.values:
        parts.append(f"-a {_quoted(' '.join(option.values))}")
    return " ".join([*parts, f"-d {_quoted(option.help)}"])


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace("'", "\\'")
    return f"'{escaped}'"
