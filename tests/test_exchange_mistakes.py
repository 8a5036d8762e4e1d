"""Outputs of shapes that cannot be written: one line, and nothing half-written."""

import os
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

import trimotion
from stages.exchange import FORMATS, format_of
from stages.exchange.exchange_options import ExchangeOptions
from tests.tracks import solve_to, write_clip
from trimotion import OptionError, OutputError

ROOT = Path(__file__).parents[1]
FULL_DISK = """
import resource, signal, sys
from pathlib import Path
import trimotion

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
track, folder, *wanted = sys.argv[1:]
trimotion.render(track, Path(folder) / "first.csv", frames=0)  # kernels find their cache
(Path(folder) / "first.csv").unlink()
resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))
for ending, style in zip(wanted[::2], wanted[1::2]):
    try:
        target = Path(folder) / f"a{ending}"
        trimotion.render(track, target, styles=style, frames=0, overwrite=True)
    except trimotion.OutputError as error:
        print(error)
    else:
        print(target.stat())
"""


@pytest.fixture(scope="module")
def track(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mistakes")
    target = folder / "in.mtrk"
    solve_to(target, write_clip(folder / "in.mp4"))
    return target


def style_of(ending: str) -> str:
    """One that the format can hold."""
    if ending not in FORMATS:
        return "flat"
    return next(one for one in ("flat", "edges") if one in format_of(f"a{ending}").styles)


def told(track: Path, target: Path, **options: object) -> str:
    """What a rendering to shapes ends with."""
    with pytest.raises((OptionError, OutputError)) as caught:
        trimotion.render(track, target, **{"styles": "flat", "frames": 0, **options})  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("ending", sorted(FORMATS))
def test_places_are_tried_before_any_work(track: Path, tmp_path: Path, ending: str) -> None:
    assert f"there is no folder {tmp_path / 'no'}" in told(track, tmp_path / "no" / f"a{ending}")
    (tmp_path / f"b{ending}").symlink_to("/dev/full")
    assert "is no regular file" in told(track, tmp_path / f"b{ending}", overwrite=True)
    (tmp_path / f"c{ending}").write_text("old")
    assert "exists already" in told(track, tmp_path / f"c{ending}")
    assert (tmp_path / f"c{ending}").read_text() == "old"
    said = told(track, tmp_path / f"d{ending}", styles="lenses")
    assert f"lenses: {ending} cannot hold it; use " in said
    assert style_of(ending) in said
    assert sorted(one.name for one in tmp_path.iterdir()) == [f"b{ending}", f"c{ending}"]


def test_other_endings_are_told_those_that_are_there(track: Path, tmp_path: Path) -> None:
    for name in ("a.fbx", "a_##.fbx", "a"):
        said = told(track, tmp_path / name)
        assert all(ending in said for ending in FORMATS)


GIVEN = {
    "svg_precision": 3,
    "svg_merge": True,
    "svg_gradients": "plain",
    "mm": 20.0,
    "relief": "0.1",
    "lottie_limit": 40,
    "usd_single": True,
}
"""A value of each option of shapes that is not its default."""


def test_options_that_change_nothing_are_refused(track: Path, tmp_path: Path) -> None:
    """They were silently ignored: `--usd-single` with a film."""
    for option in fields(ExchangeOptions):
        given = {option.name: GIVEN[option.name]}
        for ending in (".png", ".jpg", *(set(FORMATS) - set(option.metadata["endings"]))):
            said = told(track, tmp_path / f"a{ending}", styles=style_of(ending), **given)
            assert said.startswith(option.name)
            assert f": means nothing in {ending}, only in " in said
        for ending in option.metadata["endings"]:
            ExchangeOptions(**given).refuse_idle(ending)
    for ending, given in ((".png", {"crf": 20}), (".jpg", {"encoder_preset": "slow"})):
        assert "leave it out" in told(track, tmp_path / f"a{ending}", **given)
    for given in ({"samples": 4}, {"background": "red"}):
        assert f"{next(iter(given))}: .ply" in told(track, tmp_path / "a.ply", **given)


def test_too_many_triangles_for_players_are_told_before_they_are_solved(tmp_path: Path) -> None:
    source = write_clip(tmp_path / "in.mp4")
    for jobs in (1, 2):
        done: list[object] = []
        with pytest.raises(OptionError, match=r"40 triangles.* use triangles=20, or lottie_limit"):
            trimotion.animate(
                source,
                tmp_path / "a.json",
                triangles=40,
                lottie_limit=20,
                jobs=jobs,
                progress=done.append,
            )
        assert not done
    assert [one.name for one in tmp_path.iterdir()] == ["in.mp4"]


@pytest.mark.skipif(os.name != "posix", reason="limits of a process as POSIX has them")
def test_a_full_disk_leaves_what_was_there(track: Path, tmp_path: Path) -> None:
    """One program for all formats, since it takes seconds to start."""
    for ending in FORMATS:
        (tmp_path / f"a{ending}").write_text("old")
    command = [sys.executable, "-c", FULL_DISK, str(track), str(tmp_path)]
    command += [text for ending in FORMATS for text in (ending, style_of(ending))]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    for ending, line in zip(FORMATS, lines, strict=True):
        assert f"a{ending}: cannot be written (" in line
        assert "the free space" in line
        assert (tmp_path / f"a{ending}").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == len(FORMATS)
