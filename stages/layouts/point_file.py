"""Points in files: CSV, JSON, or two numbers a line."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from stages.media.text_file import read_text, reason_of
from warp_kernels.errors import MediaError

MOST_POINTS = 1_000_000
"""More are no layout."""
FORM = "write x y a line, in pixels or as parts of the picture between 0 and 1"
"""The remedy for a file that holds none."""


def read_points(name: str) -> np.ndarray:
    """Read points.

    Args:
        name: A file: two numbers a line (spaces, commas, semicolons or tabs between them, a line of
            names first, if any, with x and y among them), or JSON: a list of pairs or of objects
            with x and y, alone or as `points`.

    Returns:
        Positions, [N, 2] float64.

    Raises:
        MediaError: If it cannot be read, or holds no points.
    """
    path = Path(name)
    try:
        text = read_text(path).strip()
        is_json = path.suffix.lower() == ".json" or text[:1] in ("[", "{")
        found = _of_json(json.loads(text)) if is_json else _of_lines(text)
    except OSError as error:
        raise MediaError(name, f"cannot be read ({reason_of(error)})", FORM) from error
    except UnicodeDecodeError as error:
        raise MediaError(name, f"cannot be read ({reason_of(error)})", FORM) from error
    except (ValueError, RecursionError) as error:
        raise MediaError(name, " ".join(str(error).split())[:160], FORM) from error
    if not 1 <= len(found) <= MOST_POINTS:
        raise MediaError(name, f"holds {len(found)} points, and 1 to {MOST_POINTS} are used", FORM)
    points = np.array(found, dtype=np.float64)
    if not np.isfinite(points).all():
        raise MediaError(name, "holds a number that is not finite", FORM)
    return points


def _of_lines(text: str) -> list[tuple[float, float]]:
    """Points of a text."""
    found: list[tuple[float, float]] = []
    columns = (0, 1)
    for number, line in enumerate(text.split("\n"), start=1):
        words = [word for word in re.split(r"[\s,;]+", line.strip()) if word]
        if not words or words[0].startswith(("#", "//")):
            continue
        names = [word.strip("\"'").lower() for word in words]
        if not found and {"x", "y"} <= set(names):
            columns = names.index("x"), names.index("y")
            continue
        try:
            found.append((float(words[columns[0]]), float(words[columns[1]])))
        except (ValueError, IndexError):
            raise ValueError(f"line {number}: {line.strip()[:40]!r} is no point") from None
    return found


def _of_json(held: Any) -> list[tuple[float, float]]:
    """Points of JSON."""
    if isinstance(held, dict):
        held = next((held[key] for key in ("points", "vertices") if key in held), None)
    if not isinstance(held, list):
        raise ValueError('JSON without a list of points, alone or as "points"')
    found = []
    for number, entry in enumerate(held, start=1):
        pair: Any = [entry.get("x"), entry.get("y")] if isinstance(entry, dict) else entry
        is_pair = isinstance(pair, list) and len(pair) >= 2
        if not (is_pair and all(_is_number(value) for value in pair[:2])):
            raise ValueError(f"point {number} is {json.dumps(entry)[:40]}, not [x, y]")
        found.append((float(pair[0]), float(pair[1])))
    return found


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
