"""Completion of shells: what the parser knows, asked of the shells themselves where they are."""

import shutil
import subprocess
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from pipeline import cli
from pipeline.cli import main
from pipeline.commands.completion import SHELLS
from pipeline.commands.grammar import build_parser
from stages.focus import FOCI
from stages.look.output_size import NAMED_SIZES
from warp_kernels.styles import STYLES

# (line, the word that is completed, some of what is offered, what is not)
CASES = [
    ("trimotion ", "", {"animate", "render", "completion"}, {"--style"}),
    ("trimotion ren", "ren", {"render"}, {"animate"}),
    ("trimotion --ver", "--ver", {"--version"}, {"--style"}),
    ("trimotion animate --st", "--st", {"--style", "--start", "--stream"}, {"--size"}),
    ("trimotion animate a.mp4 -o b.mp4 --style ", "", set(STYLES), {"auto"}),
    ("trimotion animate a.mp4 --focus fa", "fa", {"faces"}, {"auto"}),
    ("trimotion animate a.mp4 --focus ", "", set(FOCI), set()),
    ("trimotion render a.mtrk --size ", "", set(NAMED_SIZES), set()),
    ("trimotion render a.mtrk --f", "--f", {"--fit", "--frames"}, {"--focus"}),
    ("trimotion animate --preset ", "", {"preview", "fine"}, set()),
    ("trimotion animate --codec ", "", {"h264", "av1"}, {"gif"}),
    ("trimotion render --background re", "re", {"red"}, {"white"}),
    ("trimotion --debug animate --device ", "", {"auto", "cpu"}, set()),
    ("trimotion styles hat", "hat", {"hatching"}, {"flat"}),
    ("trimotion help ", "", set(cli.COMMANDS), set()),
    ("trimotion completion ", "", set(SHELLS), set()),
    ("trimotion animate --fit=co", "co", {"contain", "cover"}, {"stretch"}),
]


@pytest.fixture(scope="module", params=list(SHELLS))
def script(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The script for one of the shells, as the command prints it."""
    path: Path = tmp_path_factory.mktemp("completion") / request.param
    with path.open("w") as file, redirect_stdout(file):
        assert main(["completion", request.param]) == 0
    return path


def offered(script: Path, line: str, word: str, folder: Path) -> set[str]:
    """What a shell offers for the last word of a line."""
    shell = shutil.which(script.name)
    if shell is None:
        pytest.skip(f"{script.name} is not installed")
    asked = {"bash": _bash, "zsh": _zsh, "fish": _fish}[script.name](script, line, word)
    command = [shell, *(["--norc"] if script.name == "bash" else []), "-c", asked]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    assert run.stderr == ""
    return {text.split("\t")[0].removeprefix("--fit=") for text in run.stdout.splitlines()}


def _bash(script: Path, line: str, word: str) -> str:
    words = line.replace("=", " = ").split() + ([] if word else [""])
    quoted = " ".join(f"'{text}'" for text in words)
    return (
        f"source {script}; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _trimotion; "
        "complete -p trimotion > /dev/null && printf '%s\\n' \"${COMPREPLY[@]}\""
    )


def _zsh(script: Path, line: str, word: str) -> str:
    words = line.split() + ([] if word else [""])
    quoted = " ".join(f"'{text}'" for text in words)
    return (
        "compdef() { }; _files() { print -l *(N); }; "
        "compadd() { shift; print -l -- ${(M)@:#$PREFIX*}; }; "
        'compset() { PREFIX="${PREFIX#*=}"; }; '
        '_describe() { print -l -- ${(M)${(P)@[-1]}%%:*}; print -l -- "${${(P)@[-1]}[@]%%:*}"; }; '
        f"source {script}; words=({quoted}); CURRENT={len(words)}; PREFIX='{words[-1]}'; "
        f"_trimotion | grep -- '^{word}' || true"
    )


def _fish(script: Path, line: str, word: str) -> str:
    return f"source {script}; complete -C '{line}'"


@pytest.mark.parametrize(("line", "word", "some", "others"), CASES, ids=[case[0] for case in CASES])
def test_shells_offer(
    script: Path, line: str, word: str, some: set[str], others: set[str], tmp_path: Path
) -> None:
    """Commands, options of that command, and values of that option."""
    found = offered(script, line, word, tmp_path)
    assert some <= found
    assert not others & found


@pytest.mark.parametrize("line", ["trimotion animate cl", "trimotion animate x --weights cl"])
def test_files_are_offered(script: Path, line: str, tmp_path: Path) -> None:
    """By the shell itself; bash does so where a script offers nothing."""
    (tmp_path / "clip.mp4").touch()
    found = offered(script, line, "cl", tmp_path)
    assert found == ({""} if script.name == "bash" else {"clip.mp4"})


def test_every_option_is_in_every_script(script: Path) -> None:
    """By its name: a new option needs nothing here."""
    text = script.read_text()
    for parser in build_parser().commands().values():
        for action in parser.options():
            for flag in action.option_strings:
                written = {"fish": f"-l {flag[2:]} " if flag[:2] == "--" else f"-s {flag[1:]} "}
                assert written.get(script.name, flag) in text


def test_other_shells_are_refused(capsys) -> None:
    """With those that there are."""
    assert main(["completion", "tcsh"]) == 2
    assert "fish" in capsys.readouterr().err
