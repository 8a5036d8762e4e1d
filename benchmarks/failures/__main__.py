"""Kill runs, take their memory, fill disks, take files away: what is left, as a table.

Run it in the root of the repository: python -m benchmarks.failures [KIND ...] [--kills 25]
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic

from benchmarks.failures.clusters import cluster_kills
from benchmarks.failures.disks import full_disks
from benchmarks.failures.films import LENGTH, QUICK, QUIET, SHOTS, done, write_film
from benchmarks.failures.kills import kills
from benchmarks.failures.memory import short_memory
from benchmarks.failures.pairs import pairs
from benchmarks.failures.places import places

Row = tuple[str, str]
"""What was tried, and what is wrong with what came of it; empty if nothing is."""


def main() -> None:
    """Print a line for each kind, and what went wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help="those that are tried")
    parser.add_argument("--kills", type=int, default=25, help="and limits of memory")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--folder", type=Path, help="where to work, in place of a temporary one")
    given = parser.parse_args()
    kinds: dict[str, Callable[[Path], Iterator[Row]]] = {
        "kills": lambda folder: kills(folder, given.kills, given.seed),
        "clusters": lambda folder: cluster_kills(folder, given.kills, given.seed),
        "memory": lambda folder: short_memory(folder, given.kills, given.seed),
        "disks": full_disks,
        "places": places,
        "pairs": pairs,
    }
    failed = 0
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        folder = Path(name) / "given"
        _prepare(folder)
        for kind in given.kinds or kinds:
            begun = monotonic()
            rows = list(kinds[kind](folder))
            bad = [(what, problem) for what, problem in rows if problem]
            print(f"| {kind} | {len(rows)} | {len(bad)} bad | {monotonic() - begun:.0f} s |")
            for what, problem in bad:
                print(f"  {what}: {' '.join(problem.split())[:400]}", flush=True)
            failed += len(bad)
    sys.exit(1 if failed else 0)


def _prepare(folder: Path) -> None:
    """A film, its track, and the tracks of its halves."""
    folder.mkdir()
    write_film(folder / "film.mp4")
    half = SHOTS * LENGTH // 3
    parts = {"film": "0-", "part0": f"0-{half - 1}", "part1": f"{half}-"}
    for name, frames in parts.items():
        options = ("--frames", frames, *QUICK, *QUIET)
        code, said = done(("solve", "film.mp4", "-o", f"{name}.mtrk", *options), folder)
        assert code == 0, said


if __name__ == "__main__":
    main()
