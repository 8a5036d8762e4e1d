"""The points of a row: every pixel is divided among its triangles, whatever these are."""

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

SAMPLES = 3
SIZE = (30.0, 12.0)
"""Width and height of a sample [2^-16 px]."""

list_points = point_lister(SAMPLES)


@wp.kernel(enable_backward=False)
def list_stretch(
    span: wp.array(dtype=wp.vec2i),
    line: wp.array(dtype=int),
    width: int,
    column: int,
    parts: wp.array2d(dtype=int),
    list_out: wp.array(dtype=int),
    found_out: wp.array(dtype=wp.vec3i),
):
    """List the points of one stretch."""
    if span[0][0] + wp.tid() < span[0][1]:
        most = width / 3 - column
        found_out[0] = list_points(line.ptr, width, column, most, parts.ptr, list_out.ptr)


def stretches_of(samples: np.ndarray, device: Device) -> list[tuple[np.ndarray, np.ndarray]]:
    """The list [5, ROOM] and what was found, for every stretch of a row of samples [3, 3 W]."""
    width = samples.shape[1]
    line = device.empty(samples.size + LANES, int)
    device.write(line, samples.ravel())
    parts = device.empty((1 << SAMPLES**2, 3), int)
    device.write(parts, parts_of_a_pixel(SAMPLES, SIZE))
    lists, found = device.empty(LIST, int), device.empty(1, wp.vec3i)
    column, stretches = 0, []
    while column < width // SAMPLES:
        inputs = [line, width, column, parts]
        phase = device.record(list_stretch, inputs, [lists, found])
        phase.resize(1)
        device.run([phase])
        numbers = device.read(found, 1)[0]
        stretches.append((device.read(lists, LIST).reshape(-1, ROOM), numbers))
        column += numbers[0]
    return stretches


def in_runs(width: int, longest: int, seed: int) -> np.ndarray:
    """Rows of samples [3, 3 W] with a triangle's border every now and then, about a column."""
    rng = np.random.default_rng(seed)
    borders = np.cumsum(rng.integers(1, longest + 1, 3 * width))
    columns = np.arange(3 * width)
    rows = [np.searchsorted(borders, columns + shift) for shift in (0, 1, 3)]
    return np.array(rows)


ROWS = {
    "one_pixel": np.zeros((3, 3), dtype=int),
    "one_triangle": np.full((3, 3 * 300), 7),
    "whole_pixels": np.tile(np.repeat(np.arange(300), 3), (3, 1)),
    "long_runs": in_runs(301, 90, 0),
    "short_runs": in_runs(190, 9, 1),
    "tiny_triangles": in_runs(150, 2, 2),
    "a_triangle_for_each_sample": np.arange(9 * 140).reshape(3, -1),
}


@pytest.mark.parametrize("name", ROWS)
def test_pixels_are_divided_among_their_triangles(name: str, device: str) -> None:
    """Each triangle of a pixel has one point in the middle of its samples; nothing is left out."""
    samples = ROWS[name]
    width = samples.shape[1] // SAMPLES
    pixels = samples.reshape(SAMPLES, width, SAMPLES).swapaxes(0, 1)
    down, right = np.divmod(np.arange(9), 3) - np.array([[1], [1]])
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
    samples = in_runs(137, 20, 3)
    for points, (_, _, end) in stretches_of(samples, Device(device)):
        spare = slice(end, -(-end // LANES) * LANES)
        assert (points[PIXEL // ROOM, spare] == 0).all()
        assert np.isin(points[TRIANGLE // ROOM, spare], samples).all()
