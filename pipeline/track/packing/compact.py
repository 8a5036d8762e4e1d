"""What a frame's rows hold, in few bytes: solutions lie on a grid (`stages.solve.grid`).

Each array is told as whole numbers if they give it back to the bit, and plainly otherwise; what is
read is in either case what was written.
"""

from typing import Any

import numpy as np

from pipeline.track.packing.plain import pack, unpack
from pipeline.track.packing.whole_numbers import is_whole, pack_whole, unpack_whole
from stages.mesh import Mesh
from stages.solve.color_owners import color_owners
from stages.solve.grid import (
    DROPPED,
    PLACES,
    Nodes,
    colors_through,
    shades,
    value_range,
)
from warp_kernels.color_model import CHANNELS, ColorModel

GREEN = 1
"""The channel of which the others are told by their differences."""
LARGEST_SHADE = 2.0**50
"""Colours beyond are told plainly: differences of others are whole numbers of a double."""


def pack_places(vertices: np.ndarray) -> bytes:
    """Pack positions [px], [V, 2]."""
    steps = vertices.T * PLACES
    if not (steps == np.rint(steps)).all():
        return pack(vertices, "<f8")
    return pack_whole(steps) or pack(vertices, "<f8")


def unpack_places(blob: Any, count: int) -> np.ndarray:
    """Unpack positions; ValueError if they are damaged.

    Returns:
        [V, 2].
    """
    if not is_whole(blob):
        return unpack(blob, "<f8", (count, 2))
    return np.ascontiguousarray(unpack_whole(blob, (2, count)).T) / PLACES


def pack_energies(energies: np.ndarray) -> bytes:
    """Pack energies, [T]: of those on the grid the digits that they have."""
    with np.errstate(over="ignore"):
        single = energies.astype(np.float32)
    bits = single.view(np.uint32)
    if (single == energies).all() and not (bits & ((1 << DROPPED) - 1)).any():
        return pack_whole(bits >> DROPPED) or pack(energies, "<f8")
    return pack(energies, "<f8")


def unpack_energies(blob: Any, count: int) -> np.ndarray:
    """Unpack energies; ValueError if they are damaged.

    Returns:
        [T].
    """
    if not is_whole(blob):
        return unpack(blob, "<f8", (count,))
    numbers = unpack_whole(blob, (count,))
    if not 0 <= numbers.min() <= numbers.max() < 1 << (32 - DROPPED):
        raise ValueError("an error that is no number")
    return (numbers.astype(np.uint32) << DROPPED).view(np.float32).astype(np.float64)


def pack_numbers(numbers: np.ndarray) -> bytes:
    """Pack whole numbers, [N]."""
    return pack_whole(numbers) or pack(numbers, "<i8")


def unpack_numbers(blob: Any, count: int) -> np.ndarray:
    """Unpack whole numbers; ValueError if they are damaged.

    Returns:
        [N] int64.
    """
    if not is_whole(blob):
        return unpack(blob, "<i8", (count,))
    return unpack_whole(blob, (count,)).astype(np.int64)


def pack_colors(
    mesh: Mesh,
    model: ColorModel,
    coefficients: np.ndarray,
    counts: np.ndarray,
    limits: np.ndarray | None,
) -> tuple[bytes, bytes | None]:
    """Pack colours and their limits.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].
        counts: Pixels covered: those of none show another's colour.
        limits: As in a snapshot, [T, 2, 3], or None.
    """
    plain = pack(coefficients, "<f8"), None if limits is None else pack(limits, "u1")
    values = shades(mesh, model, coefficients)
    values[:, :, counts == 0] = 0.0  # read as their owners'
    if not np.abs(values).max() < LARGEST_SHADE:  # or no number
        return plain
    back = colors_through(mesh, model, values)[color_owners(mesh, counts)]
    packed = pack_whole(_by_differences(values)) if back.tobytes() == _bytes(coefficients) else None
    if packed is None or limits is None:
        return packed or plain[0], plain[1]
    lowest, highest = value_range(values)
    spare = np.stack([limits[:, 0].T - lowest, highest - limits[:, 1].T])
    return packed, pack_whole(spare)


def unpack_colors(mesh: Mesh, model: ColorModel, blob: Any, limits: Any) -> tuple[Any, Any]:
    """Unpack colours and limits; ValueError if they are damaged.

    Args:
        mesh: The triangles, whose areas are positive.
        model: Fixes the terms.
        blob: Of the colours.
        limits: Of the limits, or None.

    Returns:
        Coefficients [T, 3, K], of triangles without a pixel anything, and limits [T, 2, 3] or None.
    """
    T = mesh.triangle_count
    if not is_whole(blob):
        colors = unpack(blob, "<f8", (T, CHANNELS, model.term_count))
        return colors, None if limits is None else unpack(limits, "u1", (T, 2, CHANNELS))
    numbers = unpack_whole(blob, (model.term_count, CHANNELS, T))
    spare, bounds = None, None
    if limits is not None and is_whole(limits):
        spare, bounds = unpack_whole(limits, (2, CHANNELS, T)), np.empty((T, 2, CHANNELS), np.uint8)
    elif limits is not None:
        bounds = unpack(limits, "u1", (T, 2, CHANNELS))
    colors, nodes = np.empty((T, CHANNELS, model.term_count)), Nodes(mesh, model)
    green: np.ndarray | float = 0.0
    for channel in (GREEN, 0, 2):  # one at a time stays in the processor's cache
        values = numbers[:, channel].astype(np.float64)
        values[1:] += values[0]
        values += green
        if channel == GREEN:
            green = values
        with np.errstate(over="ignore", invalid="ignore"):
            nodes.fit(values, colors[:, channel])
        if spare is not None and bounds is not None:
            bounds[:, :, channel] = _limits(values, spare[:, channel])
    return colors, bounds


def _limits(values: np.ndarray, spare: np.ndarray) -> np.ndarray:
    """The lowest and highest values of a channel, by how far they lie from its nodes, [T, 2]."""
    lowest, highest = value_range(values)
    lowest += spare[0]
    highest -= spare[1]
    if not (min(lowest.min(), highest.min()) >= 0 and max(lowest.max(), highest.max()) <= 255):
        raise ValueError("a limit of a colour that is none")
    return np.stack([lowest, highest], axis=1)


def _by_differences(values: np.ndarray) -> np.ndarray:
    """Green, red and blue less it; the first node, and the others less it, all [K, 3, T]."""
    numbers = values.astype(np.int64)
    numbers[1:] -= numbers[0]
    numbers[:, ::2] -= numbers[:, [GREEN]]
    return numbers


def _bytes(array: np.ndarray) -> bytes:
    return np.ascontiguousarray(array).tobytes()
