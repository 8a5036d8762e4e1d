"""Two runs on one output, one track or one folder of kernels: one wins, the other says so."""

import shutil
from collections.abc import Iterator
from pathlib import Path

from benchmarks.failures.films import QUICK, QUIET, content_of, ended, is_one_line, start

RUNS = {
    "one output": ("animate", "film.mp4", "-o", "a.mkv", "--codec", "ffv1"),
    "one track": ("solve", "film.mp4", "-o", "a.mtrk"),
    "one track, --jobs": ("solve", "film.mp4", "-o", "a.mtrk", "--jobs", "2"),
}
"""What is run twice at once."""


def pairs(given: Path) -> Iterator[tuple[str, str]]:
    """Run two at once, of each kind.

    Args:
        given: A folder with `film.mp4`, `film.mtrk` and `film.mkv` made of them.

    Yields:
        What was tried, and what is wrong; empty if nothing is.
    """
    for name, words in RUNS.items():
        yield name, _together(given, words)
    kernels = given / "kernels"
    shutil.rmtree(kernels, ignore_errors=True)
    yield "one new folder of kernels", _apart(given, {"WARP_CACHE_PATH": str(kernels)})
    for path in sorted(kernels.rglob("*.o")):
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    env = {"WARP_CACHE_PATH": str(kernels)}
    yield "a folder of half-written kernels", _apart(given, env)


def _together(given: Path, words: tuple[str, ...]) -> str:
    """Run one command twice at once; gives what is wrong."""
    options = ("--overwrite", *QUICK, *QUIET)
    ends = [ended(process) for process in [start((*words, *options), given) for _ in range(2)]]
    codes = sorted(code for code, _ in ends)
    if codes not in ([0, 4], [0, 0]):  # the second may begin when the first has ended
        return f"exit codes {codes}: {' '.join(said for _, said in ends)}"
    for code, said in ends:
        if code and not (is_one_line(said) and "another run is writing it" in said):
            return f"is told badly: {said}"
    output = given / words[3]
    found = content_of(output)
    output.unlink()
    if output.suffix == ".mtrk" and found != content_of(given / "film.mtrk"):
        return "other bits"
    return ""


def _apart(given: Path, env: dict[str, str]) -> str:
    """Solve to two tracks at once; gives what is wrong."""
    names = ("one.mtrk", "two.mtrk")
    words = [("solve", "film.mp4", "-o", name, *QUICK, *QUIET) for name in names]
    ends = [ended(process) for process in [start(one, given, env) for one in words]]
    if any(code for code, _ in ends):
        return " ".join(f"exit code {code}: {said}" for code, said in ends)
    found = {content_of(given / name) for name in names}
    for name in names:
        (given / name).unlink()
    return "" if found == {content_of(given / "film.mtrk")} else "other bits"
