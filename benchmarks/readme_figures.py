"""Are the figures of README and docs/ those that their commands give?

    python benchmarks/readme_figures.py [PAGE ...] [--keep]

A figure that can be checked has a comment behind it, which no reader of the page sees:

    an rmse of 24.8<!-- rmse of out/rmse_constant.png, within 0.1 -->
    twice as much: 2.0<!-- E_warp of out/hatching.mp4 / out/rabbit.mp4, within 5 % -->

It names what is measured, the files, and by how much the figure may be off. The command that makes
a file is the one of README or docs/ that writes it (`doc_commands.py`). Seconds are not checked:
they are another machine's.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from doc_commands import ROOT, command_for, pages, read_by, run, words_of

COMMENT = re.compile(
    r"(?P<number>-?\d[\d.,]*)[^\d<]*"
    r"<!-- (?P<what>\w+) of (?P<file>\S+?)(?: / (?P<beside>\S+?))?, "
    r"within (?P<slack>[\d.]+)(?P<percent> %)? -->"
)
TOLD = ("rmse", "triangles")
"""What a run tells of itself; all else is asked of `trimotion measure`."""
MEASURED = {
    "rmse_drawn": ("rmse", 1.0),
    "psnr": ("psnr", 1.0),
    "R": ("R", 1.0),
    "tOF": ("tOF", 1.0),
    "E_warp": ("E_warp_1", 1000.0),
    "E_warp_4": ("E_warp_4", 1000.0),
}
"""Key of a report, and the factor of its unit: E_warp is told in 1e-3."""


@dataclass(frozen=True)
class Figure:
    """A figure of a page."""

    page: str
    line: int
    number: float
    what: str
    files: tuple[str, ...]
    """One file, or two for a ratio."""
    slack: float
    """By how much the figure may be off."""
    in_percent: bool
    """Whether `slack` is a percentage of the figure."""

    @property
    def allowed(self) -> float:
        """By how much the figure may be off, in its own unit."""
        return self.slack * abs(self.number) / 100 if self.in_percent else self.slack


def figures(page: Path) -> Iterator[Figure]:
    """Find the figures of a page."""
    text = page.read_text(encoding="utf-8")
    for found in COMMENT.finditer(text):
        files = tuple(name for name in (found["file"], found["beside"]) if name)
        yield Figure(
            page=str(page.relative_to(ROOT)),
            line=text.count("\n", 0, found.start()) + 1,
            number=float(found["number"].replace(",", "").rstrip(".")),
            what=found["what"],
            files=files,
            slack=float(found["slack"]),
            in_percent=found["percent"] is not None,
        )


class Bench:
    """Runs commands, each once, and keeps what they told."""

    def __init__(self, keep: bool) -> None:
        """Begin.

        Args:
            keep: Whether files of `out/` are measured as they are, if they are there.
        """
        self._keep = keep
        self.told = cache(self._told)
        self.report = cache(self._report)

    def value(self, figure: Figure) -> float:
        """Give what a figure should be."""
        values = [self._value(figure.what, file) for file in figure.files]
        return values[0] / values[1] if len(values) == 2 else values[0]

    def _value(self, what: str, file: str) -> float:
        if what in TOLD:
            return self.told(file)[what]
        key, factor = MEASURED[what]
        return self.report(file)[key] * factor

    def _told(self, file: str) -> dict[str, float]:
        """Make a file; the means of what its run told of its frames, {} for other programs."""
        command = command_for(file)
        for other in read_by(command):
            self._there(other)
        if words_of(command)[0] != "trimotion":
            run(command)
            return {}
        # The last one counts, so a command that says --progress itself is none for this.
        lines = run(command, "--overwrite", "--progress", "json").splitlines()
        events = [json.loads(line) for line in lines if line.startswith("{")]
        frames = [event for event in events if event["event"] == "frame"]
        return {key: sum(one[key] for one in frames) / len(frames) for key in TOLD if frames}

    def _there(self, file: str) -> None:
        """See to it that a file is there."""
        if not (self._keep and (ROOT / file).exists()):
            self.told(file)

    def _report(self, file: str) -> dict[str, float]:
        """Compare a file with its source."""
        self._there(file)
        words = words_of(command_for(file))
        more = ["--frames", words[words.index("--frames") + 1]] if "--frames" in words else []
        command = " ".join(["trimotion measure", self._source(words), file, *more])
        return json.loads(run(command, "--json", "--progress", "none"))

    def _source(self, words: list[str]) -> str:
        """Give what was converted: of a drawn track the source that it was solved from."""
        first = next(word for word in words[2:] if not word.startswith("-"))
        return first if words[1] != "render" else self._source(words_of(command_for(first)))


def judged(figure: Figure, value_of: Callable[[Figure], float]) -> bool:
    """Compare a figure with what its commands give, and print both."""
    value = value_of(figure)
    holds = abs(value - figure.number) <= figure.allowed
    place = f"{figure.page}:{figure.line}"
    told = f"{figure.what} of {' / '.join(figure.files)}"
    verdict = "holds" if holds else f"DIFFERS by {value - figure.number:+.4g}"
    print(f"{place:<24} {figure.number:>8g} {value:>9.4g}  {verdict:<20} {told}", flush=True)
    return holds


def main() -> int:
    """Read the command line, check, and tell by the exit code whether all figures hold."""
    parser = argparse.ArgumentParser(description="Check the figures of README and docs/.")
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE", help="instead of all")
    parser.add_argument("--keep", action="store_true", help="take films of out/ as they are")
    options = parser.parse_args()
    (ROOT / "out").mkdir(exist_ok=True)
    bench = Bench(options.keep)
    chosen = [page.resolve() for page in options.pages] or pages()
    results = [judged(figure, bench.value) for page in chosen for figure in figures(page)]
    print(f"{sum(results)} of {len(results)} figures hold")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
