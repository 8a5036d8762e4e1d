"""Plots of lines, drawn by matplotlib in one look."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl

Points = tuple[Sequence[float], Sequence[float]]
"""x and y."""


@dataclass(frozen=True)
class Panel:
    """One pair of axes."""

    title: str
    """Above it."""
    across: str
    """What x is."""
    up: str
    """What y is."""
    lines: Mapping[str, Points]
    """By name."""
    logarithmic: bool = False
    """Whether both axes are."""


def save_curves(path: Path, panels: Sequence[Panel]) -> None:
    """Draw panels side by side, two or three in a row.

    Args:
        path: The PNG.
        panels: From left to right.
    """
    mpl.use("Agg")
    from matplotlib import pyplot

    columns = 2 if len(panels) == 4 else min(3, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = pyplot.subplots(
        rows, columns, figsize=(4.2 * columns, 3.1 * rows), squeeze=False, layout="constrained"
    )
    for axis in axes.flat[len(panels) :]:
        axis.set_axis_off()
    for axis, panel in zip(axes.flat, panels, strict=False):
        for name, (x, y) in panel.lines.items():
            axis.plot(x, y, label=name, linewidth=1.2, marker="." if len(x) < 20 else None)
        if panel.logarithmic:
            axis.set_xscale("log")
            axis.set_yscale("log")
        axis.set(xlabel=panel.across, ylabel=panel.up)
        axis.set_title(panel.title, fontsize=9)
        axis.grid(True, which="both", alpha=0.25)
        if len(panel.lines) <= 8:
            axis.legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=85)
    pyplot.close(figure)
