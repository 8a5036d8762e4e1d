"""The package that docs/extending.md shows, beside others: some that work, some that do not."""

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests import media_samples as samples

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
MORE = '''
from dataclasses import dataclass
from stages.flows.none import NoFlow
from stages.focus.center import Center
from stages.layouts.grid import Grid

@dataclass(frozen=True)
class Cells(Grid):
    """Cells."""

    rows: int = 3

@dataclass(frozen=True)
class Still(NoFlow):
    """Stillness."""

@dataclass(frozen=True)
class Spot(Center):
    """A spot."""
'''
RUN = """
import sys
from pipeline.cli import main
sys.exit(max([main(line.split()) for line in sys.argv[1:]]))
"""
GROUPS = {
    "layouts": {"cells": "more_members:Cells"},
    "flows": {"still": "more_members:Still", "dis": "more_members:Still"},
    "foci": {"spot": "more_members:Spot", "broken": "no_such_module:X"},
    "styles": {"wrong": "json:loads", "failing": "failing_module:X", "leaving": "leaving_module:X"},
}


def install(folder: Path, name: str, groups: dict[str, dict[str, str]]) -> None:
    """What an installer leaves of a package, beside its modules."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    lines = []
    for group, members in groups.items():
        lines += [f"[{group}]", *(f"{key} = {value}" for key, value in members.items())]
    (info / "entry_points.txt").write_text("\n".join(lines))


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of installed packages."""
    folder = tmp_path_factory.mktemp("packages")
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    project = tomllib.loads(text)["project"]
    install(folder, project["name"], project["entry-points"])
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    (folder / "trimotion_neon.py").write_text(code)
    install(folder, "more", {f"trimotion.{group}": names for group, names in GROUPS.items()})
    (folder / "more_members.py").write_text(MORE)
    install(folder, "damaged", {"trimotion.styles": {}})
    (folder / "damaged-1.0.dist-info" / "entry_points.txt").write_text("[trimotion.styles]\nx")
    (folder / "failing_module.py").write_text("raise RuntimeError('planted')")
    (folder / "leaving_module.py").write_text("raise SystemExit('no license')")
    return folder


def run(packages: Path, *lines: str) -> subprocess.CompletedProcess:
    """Command lines where the packages are installed, one after the other."""
    command = [sys.executable, "-c", RUN, *lines]
    environment = {**os.environ, "PYTHONPATH": str(packages)}
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)


def test_members_are_listed(packages: Path) -> None:
    """With parameters and package; those that cannot be used with the reason, in one line each."""
    done = run(packages, "styles")
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert "neon  Mean colours that glow. [trimotion-neon 1.0]" in lines
    assert lines[lines.index("neon  Mean colours that glow. [trimotion-neon 1.0]") + 1] == (
        "    gain=2               how much brighter, 1 to 8"
    )
    for option, line in (
        ("layout", "cells  Cells. [more 1.0]"),
        ("flow", "still  Stillness. [more 1.0]"),
        ("focus", "spot  A spot. [more 1.0]"),
    ):
        assert line in lines[lines.index(f"--{option}, from installed packages") :]
    for name, word in (
        ("failing", "planted"),
        ("leaving", "SystemExit: no license"),
        ("wrong", "shader"),
        ("broken", "no_such_module"),
    ):
        (line,) = (line for line in lines if line.startswith(f"{name}  "))
        assert f"{name}  cannot be used: the package more 1.0 does not work here" in line
        assert word in line
    assert "dis  Stillness. [more 1.0]" not in lines  # a name that is taken
    told = json.loads(run(packages, "styles --json").stdout)
    assert [p["name"] for p in told["--layout"]["cells"]["parameters"]] == ["rows"]
    assert told["--flow"] == {"still": {"summary": "Stillness.", "parameters": []}}
    assert "no_such_module" in told["--focus"]["broken"]["error"]


def test_help_names_members_without_importing_them(packages: Path) -> None:
    """Whatever a package does when it is imported."""
    text = run(packages, "animate --help").stdout
    assert "\n  --style neon (installed)\n" in text
    assert "\n  --style failing (installed)\n" in text
    assert "phyllotaxis|points|cells" in text


def test_members_are_used_and_stored_by_name(packages: Path, tmp_path: Path) -> None:
    """A track names them; it goes on where the package is, and is refused where it is not.

    The style's kernels are compiled, which takes its time.
    """
    clip = samples.write_video(tmp_path / "a.mkv", [samples.picture(48, 32, n) for n in range(3)])
    track, out = tmp_path / "a.mtrk", tmp_path / "a.png"
    options = "--layout cells --flow still --focus spot:size=0.5 --triangles 20 --iterations 2 -q"
    solve = f"solve {clip} -o {track} {options}"
    render = f"render {track} -o {out} --style neon:gain=3 --frames 1 -q"
    done = run(packages, f"{solve} --frames 0-1", f"{solve} --resume", f"info {track}", render)
    assert (done.returncode, done.stderr) == (0, "")
    assert "spot:size=0.5" in done.stdout
    line = run(packages.parent, f"info {track}").stderr
    assert line.count("\n") == 1
    assert "the member 'cells' of layouts, which this program does not know" in line


def test_mistakes_are_one_line(packages: Path, tmp_path: Path) -> None:
    """As those of the program's own members are."""
    clip = samples.write_still(tmp_path / "a.png", samples.picture(48, 32))
    words = {
        "neon:gain=9": "--style neon:gain=9: must lie between 1 and 8",
        "neon:glow=9": "neon has no parameter 'glow'; it has gain",
        "failing": "--style failing: the package more 1.0 does not work here (RuntimeError",
    }
    done = run(packages, *(f"animate {clip} -o {clip}.png --style {spec}" for spec in words))
    assert done.returncode == 2
    for line, wanted in zip(done.stderr.splitlines(), words.values(), strict=True):
        assert wanted in line
