"""The points of a row: every pixel is divided among its triangles, whatever these are."""

from functools import cache
from typing import Any

import numpy as np
import pytest
import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.drawing.sample_points import (
    COUNT,
    DOWN,
    LANES,
    LIST,
    PIXEL,
    RIGHT,
    ROOM,
    STRETCH,
    TRIANGLE,
    parts_of_a_pixel,
    point_lister,
)
from warp_kernels.limits import MAX_SAMPLES, SAMPLES

SIZE = (30.0, 12.0)
"""Width and height of a sample [2^-16 px]."""


@cache
def stretch_kernel(samples: int) -> Any:
    """A kernel that lists the points of one stretch."""
    list_points = point_lister(samples)

    @wp.kernel(enable_backward=False, module="unique")
    def list_stretch(
        span: wp.array(dtype=wp.vec2i),
        line: wp.array(dtype=int),
        width: int,
        column: int,
        parts: wp.array2d(dtype=int),
        list_out: wp.array(dtype=int),
        found_out: wp.array(dtype=wp.vec3i),
    ):
        """List them."""
        if span[0][0] + wp.tid() < span[0][1]:
            most = width / wp.static(samples) - column
            found_out[0] = list_points(line.ptr, width, column, most, parts.ptr, list_out.ptr)

    return list_stretch


def stretches_of(samples: np.ndarray, device: Device) -> list[tuple[np.ndarray, np.ndarray]]:
    """The list [5, ROOM] and what was found, for every stretch of a row of samples [n, n W]."""
    side, width = samples.shape
    line = device.empty(samples.size + LANES, int)
    device.write(line, samples.ravel())
    parts = device.empty((1 << side**2, 3), int)
    device.write(parts, parts_of_a_pixel(side, SIZE))
    lists, found = device.empty(LIST, int), device.empty(1, wp.vec3i)
    column, stretches = 0, []
    while column < width // side:
        inputs = [line, width, column, parts]
        phase = device.record(stretch_kernel(side), inputs, [lists, found])
        phase.resize(1)
        device.run([phase])
        numbers = device.read(found, 1)[0]
        stretches.append((device.read(lists, LIST).reshape(-1, ROOM), numbers))
        column += numbers[0]
    return stretches


def in_runs(side: int, width: int, longest: int, seed: int) -> np.ndarray:
    """Rows of samples [n, n W] with a triangle's border every now and then, about a column."""
    rng = np.random.default_rng(seed)
    borders = np.cumsum(rng.integers(1, longest + 1, side * width))
    columns = np.arange(side * width)
    rows = [np.searchsorted(borders, columns + shift) for shift in (0, 1, 3, 4)[:side]]
    return np.array(rows)


def rows_of(name: str, side: int) -> np.ndarray:
    """Rows of samples [n, n W] of a kind."""
    runs = {"long_runs": (301, 90, 0), "short_runs": (190, 9, 1), "tiny_triangles": (150, 2, 2)}
    if name in runs:
        return in_runs(side, *runs[name])
    rows = {
        "one_pixel": np.zeros((side, side), dtype=int),
        "one_triangle": np.full((side, side * 300), 7),
        "whole_pixels": np.tile(np.repeat(np.arange(300), side), (side, 1)),
        "a_triangle_for_each_sample": np.arange(side * side * 140).reshape(side, -1),
    }
    return rows[name]


NAMES = ["one_pixel", "one_triangle", "whole_pixels", "long_runs", "short_runs", "tiny_triangles"]
NAMES += ["a_triangle_for_each_sample"]


@pytest.mark.parametrize("side", [1, 2, SAMPLES, MAX_SAMPLES])
@pytest.mark.parametrize("name", NAMES)
def test_pixels_are_divided_among_their_triangles(name: str, side: int, device: str) -> None:
    """Each triangle of a pixel has one point in the middle of its samples; nothing is left out."""
    samples = rows_of(name, side)
    width = samples.shape[1] // side
    pixels = samples.reshape(side, width, side).swapaxes(0, 1)
    down, right = np.divmod(np.arange(side**2), side) - np.array([[(side - 1) / 2]])
    first = 0
    for points, (count, begin, end) in stretches_of(samples, Device(device)):
        assert 1 <= count <= begin <= STRETCH
        assert end <= ROOM
        np.testing.assert_array_equal(points[PIXEL // ROOM, :count], np.arange(count))
        listed = [*range(count), *range(begin, end)]
        rows = [PIXEL, TRIANGLE, RIGHT, DOWN, COUNT]
        found = sorted(tuple(points[[row // ROOM for row in rows], k].tolist()) for k in listed)
        expected = []
        for k in range(count):
            own = pixels[first + k].ravel()
            for triangle in np.unique(own):
                held = own == triangle
                x, y = SIZE[0] * right[held].mean(), SIZE[1] * down[held].mean()
                expected.append((k, int(triangle), round(x), round(y), int(held.sum())))
        assert found == sorted(expected)
        first += count
    assert first == width


def test_spare_points_lie_in_a_triangle_of_the_stretch(device: str) -> None:
    """They are looked at like the others: what they hold must be there."""
    samples = in_runs(SAMPLES, 137, 20, 3)
    for points, (_, _, end) in stretches_of(samples, Device(device)):
        spare = slice(end, -(-end // LANES) * LANES)
        assert (points[PIXEL // ROOM, spare] == 0).all()
        assert np.isin(points[TRIANGLE // ROOM, spare], samples).all()
