"""Help of everything, one command, one style; a word in the wrong place leads to the right one."""

import json
from pathlib import Path

import pytest

from pipeline import cli
from pipeline.cli import main
from pipeline.commands.examples import EXAMPLES
from pipeline.commands.grammar import build_parser
from warp_kernels.styles import STYLES


def refused(capsys: pytest.CaptureFixture, *arguments: str, code: int = 2) -> str:
    """The one line with which a command ends."""
    assert main(arguments) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


def test_alone_it_shows_help(capsys) -> None:
    """As usage errors do on standard error, with their code: a script lost its variable."""
    assert main([]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    for command in cli.COMMANDS:
        assert f"\n  {command} " in captured.err


@pytest.mark.parametrize("command", list(cli.COMMANDS))
def test_help_is_a_command(command: str, capsys) -> None:
    """It says what --help says, and ends with examples of this command that can be parsed."""
    assert main([command, "--help"]) == 0
    text = capsys.readouterr().out
    assert main(["help", command]) == 0
    assert capsys.readouterr().out == text
    examples = text[text.index("\nexamples:\n") :].splitlines()[2:]
    assert [line.split()[1] for line in examples] == [command] * len(EXAMPLES[command])


@pytest.mark.parametrize("line", [line for lines in EXAMPLES.values() for line in lines])
def test_examples_are_commands(line: str) -> None:
    """Options change; examples must follow."""
    build_parser().parse_args(line.split(" > ")[0].replace('"', "").split())


def test_help_without_a_topic_and_of_none(capsys) -> None:
    """All commands, or the one that was meant."""
    assert main(["help"]) == 0
    assert "trimotion COMMAND --help" in capsys.readouterr().out
    assert "did you mean render?" in refused(capsys, "help", "rendr")


def test_short_and_long_names(capsys) -> None:
    """-V, --output, and --debug on either side of the command."""
    assert main(["-V"]) == 0
    assert capsys.readouterr().out.startswith("trimotion ")
    parse = build_parser().parse_args
    assert parse(["animate", "a.mp4", "--output", "b.mp4"]).output == "b.mp4"
    for given in (["--debug", "info", "x"], ["info", "x", "--debug"], ["info", "--debug", "x"]):
        assert parse(given).debug
    assert not parse(["info", "x"]).debug


def test_one_style_is_told_of(capsys) -> None:
    """With all its parameters, for people and for programs."""
    assert main(["styles", "edges"]) == 0
    text = capsys.readouterr().out
    assert "width=" in text
    assert "opacity=" in text
    assert "spacing=" not in text
    assert main(["styles", "edges", "--json"]) == 0
    assert list(json.loads(capsys.readouterr().out)) == ["edges"]


def test_unknown_style_is_an_error(tmp_path: Path, capsys) -> None:
    """With the nearest name; a picture without --sheet says what it lacks."""
    assert "did you mean hatching?" in refused(capsys, "styles", "hatchin")
    assert ", ".join(STYLES) in refused(capsys, "styles", "zzz")
    (tmp_path / "a.png").touch()
    assert "--sheet" in refused(capsys, "styles", str(tmp_path / "a.png"))


def test_wrong_command_leads_to_the_right_one(tmp_path: Path, capsys) -> None:
    """A track to `animate`, a clip to `render`, a clip without a command, a mistyped command."""
    track, clip, out = tmp_path / "a.mtrk", tmp_path / "a.mp4", str(tmp_path / "o.mp4")
    track.write_bytes(b"SQLite format 3\0")
    clip.write_bytes(bytes(200))
    quiet = ["--progress", "none"]
    line = refused(capsys, "animate", str(track), "-o", out, *quiet, code=3)
    assert "trimotion render" in line
    line = refused(capsys, "solve", str(track), "-o", str(tmp_path / "b.mtrk"), *quiet, code=3)
    assert "trimotion render" in line
    line = refused(capsys, "render", str(clip), "-o", out, *quiet, code=3)
    assert "trimotion animate" in line
    assert f"trimotion animate {clip} -o" in refused(capsys, str(clip), "-o", out)
    assert "did you mean animate?" in refused(capsys, "animte", "a.mp4")


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("render a.mtrk -o b.mp4 --focus none", "option of animate and solve, not of render"),
        ("solve a.mp4 -o b.mtrk --style flat", "give --style to render"),
        ("animate a.mp4 -o b.mp4 --focus off", "did you mean none?"),
        ("animate a.mp4 -o b.mp4 --focus faces=2", "write faces:strength=2"),
        ("animate a.mp4 -o b.mp4 --style edges=2,color=#222", "write edges:width=2,color=#222"),
    ],
)
def test_option_in_the_wrong_place(command: str, words: str, capsys) -> None:
    """It says whose it is, or how it is written."""
    assert words in refused(capsys, *command.split())
