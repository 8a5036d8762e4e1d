"""The edges of triangles as long lines, so that a pen or a laser is seldom lifted."""

import numpy as np

from stages.exchange.plane.travel import short_way


def trails_of(edges: np.ndarray, places: np.ndarray) -> list[np.ndarray]:
    """Lines that go along every edge once.

    Where an odd number of edges meet a line must begin or end. These places are joined by hops from
    each to one that is near, and along edges and hops one line comes round to its begin; without
    the hops it falls into as few lines as there can be.

    Args:
        edges: Their ends, no two alike, [E, 2].
        places: Positions of the vertices, [V, 2].

    Returns:
        Vertices along each line, in the order of drawing.

    Source: Hierholzer, Ueber die Moeglichkeit, einen Linienzug ohne Wiederholung und ohne
        Unterbrechung zu umfahren (1873).
    """
    degrees = np.bincount(edges.reshape(-1), minlength=len(places))
    odd = np.flatnonzero(degrees % 2)
    odd = odd[short_way(places[odd])] if len(odd) else odd
    hops = odd.reshape(-1, 2)
    ways: list[list[tuple[int, int]]] = [[] for _ in range(len(places))]
    both = np.concatenate([edges, hops])
    for number, (one, other) in enumerate(both.tolist()):
        ways[one].append((other, number))
        ways[other].append((one, number))
    lines: list[np.ndarray] = []
    is_gone = [False] * len(both)
    for start in np.unique(both[:, 0]).tolist():
        round_trip = _round_trip(start, ways, is_gone)
        lines += _cut_at_hops(round_trip, len(edges))
    return lines


def _round_trip(
    start: int, ways: list[list[tuple[int, int]]], is_gone: list[bool]
) -> list[tuple[int, int]]:
    """Vertices along a line that uses up all ways that it can reach, and the way to each."""
    stack, line = [(start, -1)], []
    while stack:
        here = stack[-1][0]
        while ways[here] and is_gone[ways[here][-1][1]]:
            ways[here].pop()
        if ways[here]:
            other, number = ways[here].pop()
            is_gone[number] = True
            stack.append((other, number))
        else:
            line.append(stack.pop())
    return line


def _cut_at_hops(line: list[tuple[int, int]], edges: int) -> list[np.ndarray]:
    """A closed line without what are no edges.

    Args:
        line: Vertices, each with the number of the way that leads from it to the next one.
        edges: So many of the ways are edges, the first ones.
    """
    if len(line) < 2:
        return []
    vertices = np.array([vertex for vertex, _ in line])
    breaks = np.array([number >= edges for _, number in line[:-1]])
    if breaks.any():  # begin behind a hop, so that no line is cut where the round trip begins
        turn = int(np.flatnonzero(breaks)[0]) + 1
        vertices = np.concatenate([vertices[turn:-1], vertices[: turn + 1]])
        breaks = np.roll(breaks, -turn)
    parts = np.split(vertices, np.flatnonzero(breaks) + 1)
    return [part for part in parts if len(part) > 1]
