"""Completion for zsh."""

from collections.abc import Iterator, Mapping

from pipeline.commands.completion.words import CommandWords, OptionWords

_FRAME = """\
#compdef trimotion
# Completion of trimotion for zsh: put this into a folder of $fpath as _trimotion,
# or write source <(trimotion completion zsh) into ~/.zshrc after compinit.
_trimotion() {{
    local -a found
    local word command="" prev="${{words[CURRENT-1]}}"
    for word in "${{(@)words[2,CURRENT-1]}}"; do
        if [[ $word != -* ]]; then command="$word"; break; fi
    done
    if [[ $PREFIX == --*=* ]]; then
        prev="${{PREFIX%%=*}}"
        compset -P 1 '*='
    fi
    case "$command $prev" in
{values}
    esac
    if [[ $PREFIX == -* ]]; then
        case "$command" in
        "") found=('-h:help' '-V:the version' '--help:help' '--version:the version' '--debug') ;;
{options}
        esac
        _describe -o option found
        return
    fi
    case "$command" in
    "")
        found=({commands})
        _describe command found ;;
{arguments}
    esac
}}
if [[ $funcstack[1] == _trimotion ]]; then
    _trimotion "$@"
else
    compdef _trimotion trimotion
fi
"""


def zsh_script(commands: Mapping[str, CommandWords]) -> str:
    """Write the script.

    Args:
        commands: What may be written, by command.
    """
    options = (
        f"        {name}) found=({' '.join(_described(command))}) ;;"
        for name, command in commands.items()
    )
    arguments = (
        f"    {name}) {_offered(command.values, takes_file=command.takes_file)} ;;"
        for name, command in commands.items()
    )
    return _FRAME.format(
        commands=" ".join(_item(name, command.help) for name, command in commands.items()),
        values="\n".join(_values(commands)),
        options="\n".join(options),
        arguments="\n".join(arguments),
    )


def _values(commands: Mapping[str, CommandWords]) -> Iterator[str]:
    """What follows an option."""
    for name, command in commands.items():
        for option in filter(_has_value, command.options):
            patterns = "|".join(f'"{name} {flag}"' for flag in option.flags)
            offered = _offered(option.values, takes_file=option.takes_file)
            yield f"    {patterns}) {offered}; return ;;"


def _has_value(option: OptionWords) -> bool:
    return option.takes_value


def _offered(values: tuple[str, ...], *, takes_file: bool) -> str:
    """Commands of zsh that offer values and names of files."""
    parts = [f"compadd -- {' '.join(map(_quoted, values))}"] if values else []
    return "; ".join([*parts, *(["_files"] if takes_file else [])]) or ":"


def _described(command: CommandWords) -> Iterator[str]:
    for option in command.options:
        for flag in option.flags:
            yield _item(flag, option.help)


def _item(word: str, text: str) -> str:
    return _quoted(f"{word}:{text}")


def _quoted(text: str) -> str:
    escaped = text.replace("'", "'\\''")
    return f"'{escaped}'"
