"""Shapes as the text of SVG, many at a time."""

from collections.abc import Sequence
from functools import cache

import numpy as np


def rounded(numbers: np.ndarray, precision: int) -> np.ndarray:
    """Numbers as they will be written; a zero has no sign."""
    return np.asarray(np.round(numbers, precision) + 0.0)


def lines_of(template: str, *columns: np.ndarray) -> list[str]:
    """One text for every row.

    Args:
        template: With a place for each number, such as `<circle r="%.9g"/>`.
        columns: Tables with as many columns together, [N] or [N, C] each.
    """
    tables = [column if column.ndim > 1 else column[:, None] for column in columns]
    rows = np.concatenate([table.astype(object) for table in tables], axis=1)
    return filled([template] * len(rows), rows)


def filled(templates: Sequence[str], numbers: np.ndarray) -> list[str]:
    """Templates with their numbers, one after the other.

    Args:
        templates: Each takes as many numbers as it has places.
        numbers: Those of all.
    """
    if len(templates) == 0:
        return []
    return ("\n".join(templates) % tuple(numbers.ravel().tolist())).split("\n")


def path_data(points: np.ndarray, counts: np.ndarray, precision: int) -> list[str]:
    """Closed lines as path data.

    Args:
        points: Corners of all [px], [P, 2].
        counts: Corners of each, [L].
        precision: Decimals.
    """
    return filled([_open(count) + "z" for count in counts.tolist()], rounded(points, precision))


def open_lines(points: np.ndarray, counts: np.ndarray, precision: int) -> list[str]:
    """Open lines as path data.

    Args:
        points: Those of all [px], [P, 2].
        counts: Points of each, [L].
        precision: Decimals.
    """
    return filled([_open(count) for count in counts.tolist()], rounded(points, precision))


@cache
def _open(count: int) -> str:
    return "M%.9g %.9gL" + " ".join(["%.9g %.9g"] * (count - 1))


def hexes(colors: np.ndarray) -> list[str]:
    """Colours as `#rrggbb`.

    Args:
        colors: Code values, [N, 3] uint8.
    """
    return filled(["#%02x%02x%02x"] * len(colors), colors)


def ids_of(name: str, numbers: np.ndarray) -> list[str]:
    """Ids of elements.

    Args:
        name: Their begin.
        numbers: Those of triangles, [N] int64.
    """
    return [f"{name}-{number}" for number in numbers.tolist()]


def elements(template: str, *columns: Sequence[object]) -> list[str]:
    """One element for every row of texts.

    Args:
        template: With `%s` for each.
        columns: What stands there.
    """
    return [template % row for row in zip(*columns, strict=True)]
