"""A film from left to right: bands, lines and ticks above thumbnails."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

PAPER, INK, FAINT = (250, 250, 248), (40, 40, 44), (205, 205, 205)
"""Ground, letters and ruled lines [code values]."""
HUES = ((88, 134, 184), (214, 138, 78), (112, 164, 106), (176, 112, 168), (196, 174, 82))
"""Colours of bands in turn [code values]."""
LINE = (54, 92, 150)
"""Colour of curves [code values]."""
EDGE, BAND, ROW, TICKS, GAP = 12, 34, 40, 26, 6
"""Border and heights of what lies below each other [px]."""


@dataclass(frozen=True)
class Band:
    """A stretch with a name."""

    begin: float
    """Where it begins, as a part of the whole, 0 to 1."""
    settled: float
    """Where what leads into it ends."""
    end: float
    """Where it ends."""
    name: str
    """What is written on it."""


@dataclass(frozen=True, eq=False)
class Graph:
    """Something that changes, at even places from left to right."""

    name: str
    """What is written beside it."""
    numbers: np.ndarray | None
    """Values, [N], NaN where there is none; None for colours."""
    colors: np.ndarray | None = None
    """Colours instead [code values], [N, 3]."""
    note: str = ""
    """What is written after the name, such as its bounds."""


def strip_of(
    bands: Sequence[Band],
    graphs: Sequence[Graph],
    ticks: Sequence[tuple[float, bool]],
    marks: Sequence[tuple[float, str]],
    pictures: Sequence[np.ndarray],
    width: int,
) -> np.ndarray:
    """Draw a strip.

    Args:
        bands: Stretches of the film.
        graphs: What changes.
        ticks: Beats: where they are, 0 to 1, and whether a bar begins.
        marks: Places that are named, such as times.
        pictures: Moments at even places, [H, W, 3] uint8, all of one size.
        width: Columns of the strip [px].

    Returns:
        Code values, [rows, columns, 3] uint8.
    """
    inner = width - 2 * EDGE
    shown = _thumbnails(pictures, inner)
    height = 2 * EDGE + 20 + BAND + (TICKS + GAP if ticks else 0) + len(graphs) * (ROW + GAP)
    sheet = np.full((height + GAP + shown.shape[0], width, 3), PAPER, np.uint8)
    top = _marks(sheet, marks, inner)
    top = _bands(sheet, bands, top, inner)
    if ticks:
        for place, is_bar in ticks:
            x = EDGE + round(place * (inner - 1))
            length = TICKS if is_bar else TICKS // 2
            cv2.line(sheet, (x, top + TICKS - length), (x, top + TICKS - 1), INK, 1)
        top += TICKS + GAP
    for graph in graphs:
        _graph(sheet, graph, top, inner)
        top += ROW + GAP
    sheet[top : top + shown.shape[0], EDGE : EDGE + shown.shape[1]] = shown
    return sheet


def _thumbnails(pictures: Sequence[np.ndarray], width: int) -> np.ndarray:
    """Pictures side by side, [rows, width, 3]."""
    edges = np.linspace(0, width, len(pictures) + 1).round().astype(int)
    rows, columns = pictures[0].shape[:2]
    height = max(1, round(rows * (width / len(pictures)) / columns))
    cells = [
        cv2.resize(picture, (int(right - left), height), interpolation=cv2.INTER_AREA)
        for picture, left, right in zip(pictures, edges[:-1], edges[1:], strict=True)
    ]
    return np.concatenate(cells, axis=1)


def _marks(sheet: np.ndarray, marks: Sequence[tuple[float, str]], width: int) -> int:
    """Write names along the top; gives the row below them."""
    free = 0
    for place, name in marks:
        x = EDGE + round(place * (width - 1))
        if x >= free:
            _write(sheet, name, (x, EDGE + 12), 0.36)
            free = x + 8 * len(name) + 10
    return EDGE + 20


def _bands(sheet: np.ndarray, bands: Sequence[Band], top: int, width: int) -> int:
    """Draw the stretches; gives the row below them."""
    for number, band in enumerate(bands):
        hue = HUES[number % len(HUES)]
        left, settled, right = (
            EDGE + round(place * width) for place in (band.begin, band.settled, band.end)
        )
        sheet[top : top + BAND, left:right] = hue
        if number and settled > left:  # what leads into it: from the colour before to its own
            share = np.linspace(0, 1, settled - left)[None, :, None]
            before = np.array(HUES[(number - 1) % len(HUES)])
            sheet[top : top + BAND, left:settled] = before + share * (np.array(hue) - before)
        room = max(0, (right - left - 10) // 8)
        name = band.name if len(band.name) <= room else band.name[: max(0, room - 1)] + "."
        if room > 2:
            _write(sheet, name, (left + 6, top + BAND - 12), 0.42, (255, 255, 255))
    return top + BAND + GAP


def _graph(sheet: np.ndarray, graph: Graph, top: int, width: int) -> None:
    """Draw a curve or a strip of colours, and its name over it."""
    bottom = top + ROW - 1
    cv2.line(sheet, (EDGE, bottom), (EDGE + width - 1, bottom), FAINT, 1)
    if graph.colors is not None:
        places = np.arange(width) * len(graph.colors) // width
        sheet[top + 16 : bottom, EDGE : EDGE + width] = graph.colors[places]
    elif graph.numbers is not None and np.isfinite(graph.numbers).any():
        values = graph.numbers
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        rise = (values - low) / (high - low) if high > low else np.full_like(values, 0.5)
        xs = EDGE + np.linspace(0, width - 1, len(values))
        ys = bottom - 2 - rise * (ROW - 18)
        run: list[tuple[float, float]] = []
        for x, y in [*zip(xs, ys, strict=True), (0.0, np.nan)]:
            if np.isfinite(y):
                run.append((x, y))
                continue
            if run:
                points = np.rint(np.array(run) * 8).astype(np.int32)
                cv2.polylines(sheet, [points], False, LINE, 1, cv2.LINE_AA, 3)
            run = []
    _write(sheet, f"{graph.name}  {graph.note}".rstrip(), (EDGE, top + 11), 0.36)


def _write(
    sheet: np.ndarray,
    text: str,
    at: tuple[int, int],
    size: float,
    color: tuple[int, int, int] = INK,
) -> None:
    cv2.putText(sheet, text, at, cv2.FONT_HERSHEY_DUPLEX, size, color, 1, cv2.LINE_AA)
