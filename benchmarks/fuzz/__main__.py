"""Broken media, presets, tracks and hostile files, in one process: a line of a table for each kind.

Run it in the root of the repository:
python -m benchmarks.fuzz [--media 2000] [--presets 200] [--tracks 300] [--hostile FOLDER]
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path

from benchmarks.fuzz import media, presets
from benchmarks.fuzz.watch import Watch
from tests.bad_tracks import copy_of, discard
from tests.tracks import QUICK_FLAGS, solve_to, write_clip

QUIET = ("--progress", "none")


def main() -> None:
    """Try all kinds, and print what was not as it must be."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--media", type=int, default=2000)
    parser.add_argument("--presets", type=int, default=200)
    parser.add_argument("--tracks", type=int, default=300)
    parser.add_argument("--hostile", type=Path, help="a folder of files, each is converted")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for watch in _all(folder, given):
            print(watch, flush=True)
            print("".join(f"  {problem}\n" for problem in watch.bad), end="", flush=True)
            bad += len(watch.bad)
    sys.exit(1 if bad else 0)


def _all(folder: Path, given: argparse.Namespace) -> Iterator[Watch]:
    if given.media:
        yield broken_media(folder, given.media, given.seed)
    if given.presets:
        yield broken_presets(folder, given.presets, given.seed)
    if given.tracks:
        yield broken_tracks(folder, given.tracks)
    if given.hostile:
        yield hostile_files(folder, given.hostile)


def broken_media(folder: Path, count: int, seed: int) -> Watch:
    """Read damaged media.

    Args:
        folder: Where they may be written.
        count: How many.
        seed: Chooses the damage.
    """
    watch = Watch("mutated media")
    for path in islice(media.mutants(folder, seed), count):
        watch.attempt(f"seed {seed}: {path.name}", partial(media.read, path))
    return watch


def broken_presets(folder: Path, count: int, seed: int) -> Watch:
    """Check damaged presets, and other texts that options name.

    Args:
        folder: Where they may be written.
        count: How many.
        seed: Chooses the damage.
    """
    clip = write_clip(folder / "clip.mp4")
    watch = Watch("broken presets and lists")
    for flags in islice(presets.broken(folder, seed), count):
        # one frame is solved where the damage means something
        wanted = ("--frames", "0", "--triangles", "12", "--iterations", "1", "--scale", "1")
        output = str(folder / "out.png")
        watch.command(["animate", str(clip), "-o", output, "--overwrite", *wanted, *flags, *QUIET])
    return watch


def broken_tracks(folder: Path, count: int) -> Watch:
    """Look at damaged tracks, and draw them.

    Args:
        folder: Where they may be written.
        count: How many.
    """
    clip = write_clip(folder / "in.mp4")
    good = folder / "good.mtrk"
    solve_to(good, clip, "0-3")
    watch = Watch("broken tracks")
    for number in range(count):
        bad = copy_of(good, folder, number)
        commands: tuple[Callable[[], list[str]], ...] = (
            lambda: ["info", str(bad)],  # noqa: B023 - run at once
            lambda: ["render", str(bad), "-o", str(bad.parent / "a.mp4"), *QUIET],  # noqa: B023
        )
        watch.command(commands[number % 2](), codes=(3,))
        discard(bad)
    return watch


def hostile_files(folder: Path, hostile: Path) -> Watch:
    """Convert strange files.

    Args:
        folder: Where outputs may be written.
        hostile: Where they are.
    """
    watch = Watch("hostile files")
    for path in sorted(hostile.iterdir()):
        output = folder / f"{path.name}.mkv"
        watch.command(
            ["animate", str(path), "-o", str(output), "--frames", "0-15", *QUICK_FLAGS, *QUIET]
        )
        output.unlink(missing_ok=True)
    return watch


if __name__ == "__main__":
    main()
