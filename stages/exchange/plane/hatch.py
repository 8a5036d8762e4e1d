"""Lines that fill triangles to a tone: of one width, so that one pen draws them all.

What makes a triangle darker is how near lines lie to each other. They are as long together as the
tone asks for: lines that lie a little too near are shortened. All of a stroke lies in its triangle,
with its corners too, as far as the tone can be reached so: what sticks out darkens others.
"""

from dataclasses import dataclass

import numpy as np

from stages.exchange.plane.tones import turned
from warp_kernels.scene.stroke_lay import Lay

ROUNDS = 24
"""Times that lines of triangles with too few are moved together, at most."""
CLOSER = 0.97
"""How much closer than they seem to need they are moved then."""
BEYOND = 1e9
"""Farther than any place [px]."""
LEAST = 1e-3
"""Shorter strokes are left out [px]."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Straight strokes, triangle by triangle, side by side within each."""

    triangles: np.ndarray
    """Which one each lies in, ascending, [N]."""
    ends: np.ndarray
    """Begin and end [px of the picture], [N, 2, 2]."""


def hatched(
    corners: np.ndarray, lay: Lay, turn: float, shift: float, tones: np.ndarray, width: float
) -> Segments:
    """Fill triangles with parallel lines.

    Args:
        corners: Positions [px], [T, 3, 2].
        lay: Where strokes lie and lead.
        turn: How far lines are turned from there [degrees].
        shift: How far they lie aside [distances of neighbours].
        tones: Part of each triangle that lines shall cover, 0 to 1, [T].
        width: Of the lines [px].
    """
    along = lay.directions @ turned(turn)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    away = corners - lay.places[:, None]
    flat = np.stack(
        [np.einsum("tki,ti->tk", away, along), np.einsum("tki,ti->tk", away, across)], axis=2
    )
    first, second = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    areas = 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    wanted = tones * areas / width
    drawn = np.flatnonzero(wanted > LEAST)
    distances = width / np.maximum(tones[drawn], 1e-6)
    for _ in range(ROUNDS):
        lines = _chords(flat[drawn], distances, shift, width)
        reached = np.bincount(lines.rows, weights=lines.insides, minlength=len(drawn))
        is_short = (reached < wanted[drawn]) & (distances > width)
        if not is_short.any():
            break
        closer = np.maximum(CLOSER * reached / wanted[drawn], 0.5)
        distances = np.where(is_short, np.maximum(distances * closer, width), distances)
    lengths = _lengths(lines, wanted[drawn])
    rows = drawn[lines.rows]
    turns = np.where(lines.numbers % 2 == 0, 1.0, -1.0)  # there and back: the pen need not go far
    halves = 0.5 * turns * lengths
    begins, ends = lines.middles - halves, lines.middles + halves
    places = lay.places[rows] + lines.heights[:, None] * across[rows]
    strokes = np.stack([places + one[:, None] * along[rows] for one in (begins, ends)], axis=1)
    is_seen = lengths > LEAST
    return Segments(rows[is_seen], strokes[is_seen])


@dataclass(frozen=True, eq=False)
class _Chords:
    """Parts of lines that lie in triangles; lines run to the right."""

    rows: np.ndarray
    """Which triangle each lies in, [N]."""
    numbers: np.ndarray
    """Which line of it, [N]."""
    heights: np.ndarray
    """Where the line lies across [px], [N]."""
    middles: np.ndarray
    """Where the middle of what lies wholly inside is along it [px], [N]."""
    insides: np.ndarray
    """How long a stroke lies wholly inside [px], [N]."""
    wholes: np.ndarray
    """How long it is if it sticks out on both ends as much as is missing beside [px], [N]."""


def _lengths(lines: _Chords, wanted: np.ndarray) -> np.ndarray:
    """How long strokes are that reach what is wanted of each triangle [px], [N].

    Args:
        lines: Where they lie.
        wanted: Length of all strokes of each triangle [px], [M].
    """
    inside, whole = (
        np.bincount(lines.rows, weights=one, minlength=len(wanted))
        for one in (lines.insides, lines.wholes)
    )
    kept = np.minimum(wanted / np.maximum(inside, LEAST), 1.0)
    missing = np.clip((wanted - inside) / np.maximum(whole - inside, LEAST), 0.0, 1.0)
    more = missing[lines.rows] * (lines.wholes - lines.insides)
    return np.asarray(kept[lines.rows] * lines.insides + more)


def _chords(flat: np.ndarray, distances: np.ndarray, shift: float, width: float) -> _Chords:
    """Cut lines at even distances with triangles.

    Args:
        flat: Corners along and across the lines [px], [M, 3, 2].
        distances: Of neighbouring lines [px], [M].
        shift: Where the line of number 0 lies [distances].
        width: Of the lines [px].
    """
    heights = flat[:, :, 1]
    first = np.ceil(heights.min(axis=1) / distances - shift).astype(np.int64)
    last = np.floor(heights.max(axis=1) / distances - shift).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    rows = np.repeat(np.arange(len(flat)), counts)
    ranks = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
    numbers = first[rows] + ranks
    height = (numbers + shift) * distances[rows]
    low, high = _cut(flat[rows], height)
    sides = [_cut(flat[rows], height + side * width) for side in (-0.5, 0.5)]
    left = np.maximum(low, np.maximum(sides[0][0], sides[1][0]))
    right = np.minimum(high, np.minimum(sides[0][1], sides[1][1]))
    # where no stroke fits inside, a whole one lies about the middle of its line
    middle = np.where(right > left, 0.5 * (left + right), 0.5 * (low + high))
    inside = np.maximum(right - left, 0.0)
    return _Chords(rows, numbers, height, middle, inside, np.maximum(high - low, inside))


def _cut(corners: np.ndarray, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where lines enter and leave triangles [px], [N] each; turned round where they do not.

    Args:
        corners: Along and across the lines [px], [N, 3, 2].
        heights: Where the lines lie across [px], [N].
    """
    following = np.roll(corners, -1, axis=1)
    rise = following[:, :, 1] - corners[:, :, 1]
    share = (heights[:, None] - corners[:, :, 1]) / np.where(rise == 0.0, np.inf, rise)
    is_cut = (rise != 0.0) & (share >= 0.0) & (share <= 1.0)
    places = corners[:, :, 0] + share * (following[:, :, 0] - corners[:, :, 0])
    low = np.where(is_cut, places, BEYOND).min(axis=1)
    return low, np.where(is_cut, places, -BEYOND).max(axis=1)
