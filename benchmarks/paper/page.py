"""The page that a study writes: checks on top, then a section for each experiment."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.paper.study import Study
from benchmarks.timing import machine, table

HEADS = ("experiment", "check", "bar", "figure", "")


@dataclass(frozen=True)
class Check:
    """One thing that should hold."""

    name: str
    """What is compared."""
    bar: str
    """What it should reach."""
    figure: str
    """What it reached."""
    holds: bool
    """Whether that is enough."""


@dataclass(frozen=True)
class Section:
    """What an experiment found."""

    title: str
    """Its heading."""
    body: str
    """Markdown."""
    checks: tuple[Check, ...] = ()
    """What should hold."""


def write_page(path: Path, study: Study, sections: Sequence[Section], command: str) -> None:
    """Write the page.

    Args:
        path: The Markdown file.
        study: What was studied.
        sections: What was found, in order.
        command: The command line that repeats it.
    """
    rows = [
        (section.title.split(":")[0], check.name, check.bar, check.figure, _verdict(check))
        for section in sections
        for check in section.checks
    ]
    pictures = ", ".join(
        f"{name} ({pixels.shape[1]}x{pixels.shape[0]})" for name, pixels in study.pictures.items()
    )
    parts = [
        "# The paper's experiments on free pictures",
        f"`{command}` writes this page. It repeats the evaluation of Lawonn & Guenther, "
        '"Stylized Image Triangulation" (2018), Sec. 6.',
        f"Pictures: {pictures}. Machine: {machine()}; {study.device!r}. Seed {study.seed}.",
        "The rmse is the root mean square over pixels and channels of the difference between "
        "picture and drawn colour [code values]; the paper's R (Eq. 12) is sqrt(3 / 2) of it. "
        "Seconds are those of one triangulation, from the decoded picture to the fitted colours.",
    ]
    if study.iterations is not None:
        parts.append(f"**A quick try: at most {study.iterations} iterations.**")
    if rows:
        parts += ["## Checks", table(HEADS, rows)]
    for section in sections:
        parts += [f"## {section.title}", section.body]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def _verdict(check: Check) -> str:
    return "holds" if check.holds else "**fails**"


def picture(study: Study, name: str, meaning: str) -> str:
    """The Markdown of a plot in the study's folder.

    Args:
        study: The study.
        name: File of the plot.
        meaning: What it shows.
    """
    return f"![{meaning}]({study.plots.name}/{name})"
