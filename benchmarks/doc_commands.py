"""The commands that README and the pages of `docs/` show, and the files that they make.

Commands stand in blocks of `sh`. Those that are run for a picture or a figure but not shown stand
in a comment of the page that begins with `also run:`, one a line.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def pages() -> list[Path]:
    """README and the pages of docs/, README first."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def shown_by(page: Path) -> list[str]:
    """Give the commands that a page shows, one a line, without comments."""
    return _lines(re.findall(r"```sh\n(.*?)```", page.read_text("utf-8"), flags=re.DOTALL))


def commands_of(page: Path) -> list[str]:
    """Give the commands that a page shows, and those that it runs besides."""
    text = page.read_text("utf-8")
    hidden = re.findall(r"<!-- also run:\n(.*?)-->", text, flags=re.DOTALL)
    return [*shown_by(page), *_lines(hidden)]


def _lines(blocks: list[str]) -> list[str]:
    lines = "\n".join(blocks).replace("\\\n", " ").splitlines()
    # Comments, redirections and pipes are the shell's.
    return [line for line in (re.split(r"\s[#>|]\s", line)[0].strip() for line in lines) if line]


def commands() -> list[str]:
    """Give every command that writes to `out/`, those of README first."""
    found = (line for page in pages() for line in commands_of(page))
    return list(dict.fromkeys(line for line in found if re.search(r"\bout/", line)))


def words_of(command: str) -> list[str]:
    """Split a command as a shell does, without variables in front of it."""
    return [word for word in shlex.split(command) if word != "PYTHONPATH=."]


def written_by(command: str) -> str:
    """Give the file that a command writes, `out/shot_####.png` for numbered stills, or ''."""
    words = words_of(command)
    for flag in ("-o", "--sheet"):
        if flag in words:
            return words[words.index(flag) + 1]
    return words[-1] if words[:1] == ["python"] else ""


def command_for(file: str) -> str:
    """Give the command that writes a file of `out/`.

    Raises:
        ValueError: If no page has one.
    """
    for command in commands():
        pattern = re.escape(written_by(command)).replace(r"\#", "[0-9]")
        if written_by(command) == file or re.fullmatch(pattern, file):
            return command
    raise ValueError(f"{file}: no command of README or docs/ writes it; add one")


def run(command: str, *more: str) -> str:
    """Run a command in the root of the repository with the code that lies there.

    Args:
        command: As a page shows it.
        more: Further words behind it.

    Returns:
        What it printed.
    """
    print(f"$ {command}", file=sys.stderr, flush=True)
    words = [*words_of(command), *more]
    if written := written_by(command):
        for old in ROOT.glob(written.replace("#", "[0-9]")):
            old.unlink()
    start = {"trimotion": ["-m", "pipeline.cli"], "python": []}[words[0]]
    paths = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, *start, *words[1:]],
        cwd=ROOT,
        env=paths,
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return done.stdout


def make(file: str, made: set[str], keep: bool) -> None:
    """Make a file of `out/`, and before it what its command reads.

    Args:
        file: From the root of the repository.
        made: Commands that have run; grows.
        keep: Whether a file that is there already is good enough.
    """
    if not file.startswith("out/") or (keep and (ROOT / file).exists()):
        return
    command = command_for(file)
    if command in made:
        return
    for word in read_by(command):
        make(word, made, keep)
    run(command)
    made.add(command)


def read_by(command: str) -> list[str]:
    """Give the files of `out/` that a command reads; of numbered stills the pattern."""
    words = words_of(command)
    written = {written_by(command)}
    if "animate" in words and "--track" in words:
        written.add(words[words.index("--track") + 1])
    return [word for word in words if word.startswith("out/") and word not in written]
