"""Figures over frames as a drawing in SVG that stands inside of a page."""

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np

WIDTH, HEIGHT = 800, 150
"""Of a plot [units of the drawing]."""
LEFT, RIGHT, TOP, BOTTOM = 60, 10, 10, 22
"""Margins for the words [units]."""
MOST_POINTS = 1000
"""Of a line; a longer film shows the lowest and the highest of every few frames."""


def plot(
    title: str, frames: Sequence[int], values: Sequence[float | None], cuts: Sequence[int]
) -> str:
    """Draw figures of frames, and where shots begin.

    Args:
        title: What is drawn.
        frames: Numbers of the frames, ascending.
        values: A figure for each; the line has a gap where there is none.
        cuts: Frames at which shots begin.
    """
    known = np.array([np.nan if value is None else value for value in values], dtype=np.float64)
    at = np.array(frames, dtype=np.float64)
    highest = float(np.nanmax(known)) if np.isfinite(known).any() else 0.0
    highest = highest or 1.0
    across = (WIDTH - LEFT - RIGHT) / max(1.0, float(at[-1] - at[0]))
    up = (HEIGHT - TOP - BOTTOM) / highest
    x, y = LEFT + (at - at[0]) * across, HEIGHT - BOTTOM - known * up
    marks = [LEFT + (cut - at[0]) * across for cut in cuts]
    lines = [
        f'<svg role="img" viewBox="0 0 {WIDTH} {HEIGHT}" xmlns="http://www.w3.org/2000/svg">',
        f"<title>{escape(title)}</title>",
        *(
            f'<path class="cut" d="M{mark:.1f} {TOP}V{HEIGHT - BOTTOM}">'
            f"<title>a shot begins at frame {cut}</title></path>"
            for mark, cut in zip(marks, cuts, strict=True)
        ),
        f'<path class="axis" d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}"/>',
        *(f'<path class="line" d="{line}"/>' for line in _lines(x, y)),
        f'<text x="{LEFT - 6}" y="{TOP + 8}" text-anchor="end">{highest:.6g}</text>',
        f'<text x="{LEFT - 6}" y="{HEIGHT - BOTTOM}" text-anchor="end">0</text>',
        f'<text x="{LEFT}" y="{HEIGHT - 6}">frame {frames[0]}</text>',
        f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 6}" text-anchor="end">{frames[-1]}</text>',
        "</svg>",
    ]
    return "\n".join(lines)


def _lines(x: np.ndarray, y: np.ndarray) -> Iterator[str]:
    """Paths, one for each run of frames that have a figure; a lone one is a dot."""
    is_known = np.isfinite(y)
    borders = np.flatnonzero(np.diff(is_known.astype(int))) + 1
    for part in np.split(np.arange(len(y)), borders):
        if not is_known[part[0]]:
            continue
        points = _thinned(part, y)
        places = [f"{x[point]:.1f} {y[point]:.1f}" for point in points]
        yield "M" + "L".join(places) + ("h1" if len(places) == 1 else "")


def _thinned(part: np.ndarray, y: np.ndarray) -> list[int]:
    """The frames of a run that are drawn: all, or the extremes of every few."""
    if len(part) <= MOST_POINTS:
        return [int(one) for one in part]
    groups = np.array_split(part, MOST_POINTS // 2)
    extremes = (sorted({int(g[y[g].argmin()]), int(g[y[g].argmax()])}) for g in groups)
    return [one for pair in extremes for one in pair]
