"""Completion for bash 3.2 and newer, without the package bash-completion."""

from collections.abc import Iterator, Mapping

from pipeline.commands.completion.words import CommandWords

_FRAME = """\
# Completion of trimotion for bash:
#   trimotion completion bash > ~/.local/share/bash-completion/completions/trimotion
_trimotion() {{
    local cur="${{COMP_WORDS[COMP_CWORD]}}" prev="${{COMP_WORDS[COMP_CWORD-1]}}"
    local command="" words="" i
    # bash takes --style=flat for three words
    if [[ $cur == "=" ]]; then
        cur=""
    elif [[ $prev == "=" && $COMP_CWORD -gt 1 ]]; then
        prev="${{COMP_WORDS[COMP_CWORD-2]}}"
    fi
    for ((i = 1; i < COMP_CWORD; i++)); do
        if [[ ${{COMP_WORDS[i]}} != -* ]]; then command="${{COMP_WORDS[i]}}"; break; fi
    done
    COMPREPLY=()
    case "$command $prev" in
{values}
    *)
        case "$command" in
        "") words="{commands}" ;;
{arguments}
        esac
        if [[ $cur == -* ]]; then
            case "$command" in
            "") words="-h --help -V --version --debug" ;;
{options}
            esac
        fi
        ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
}}
complete -o default -F _trimotion trimotion
"""


def bash_script(commands: Mapping[str, CommandWords]) -> str:
    """Write the script; names of files are completed by bash itself where nothing else is.

    Args:
        commands: What may be written, by command.
    """
    arguments = (
        f'        {name}) words="{" ".join(command.values)}" ;;'
        for name, command in commands.items()
    )
    options = (
        f'            {name}) words="{" ".join(_flags(command))}" ;;'
        for name, command in commands.items()
    )
    return _FRAME.format(
        commands=" ".join(commands),
        values="\n".join(_values(commands)),
        arguments="\n".join(arguments),
        options="\n".join(options),
    )


def _values(commands: Mapping[str, CommandWords]) -> Iterator[str]:
    """What follows an option, one line for all commands and names that it has."""
    lines: dict[str, list[str]] = {}
    for name, command in commands.items():
        for option in command.options:
            if option.takes_value:
                patterns = (f'"{name} {flag}"' for flag in option.flags)
                lines.setdefault(" ".join(option.values), []).extend(patterns)
    for values, named in lines.items():
        yield f"    {'|'.join(named)})"
        yield f'        words="{values}" ;;'


def _flags(command: CommandWords) -> Iterator[str]:
    for option in command.options:
        yield from option.flags
