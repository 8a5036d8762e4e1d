"""Where a row of pixels is looked at: every pixel at its centre, those on a border once per side.

A pixel whose samples all lie in one triangle is one point. A pixel on a border is a point for each
of its triangles, in the middle of the samples that lie in it: the first stands among the pixels,
the others behind all of them. So the points of a stretch are a list, and colours are worked out
for many of them at once.

The list is made by a snippet of C++: it compares sixteen samples at a time, which no loop in
Python that ends early becomes, and branches as little as it can, for nobody can guess where a
border runs.
"""

from functools import cache
from typing import Any

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

STRETCH = 128
"""Pixels of a row that are drawn at a time; what is known of them stays in the nearest cache."""
ROOM = 2 * STRETCH
"""Points of a stretch at most; one that needed more ends earlier."""
LANES = 16
"""Behind the last point some spare ones make the list a whole multiple of so many long: as many
numbers as fit into a processor's register."""
PIXEL, TRIANGLE, RIGHT, DOWN, COUNT = 0, ROOM, 2 * ROOM, 3 * ROOM, 4 * ROOM
"""Where in a list they are: for every point the pixel to which it belongs, counted from the first
of the stretch, the triangle in which it lies, its place from the pixel's centre [2^-16 px] and the
number of the pixel's samples for which it stands."""
LIST = 5 * ROOM
"""Numbers of a list."""


def parts_of_a_pixel(samples: int, size: tuple[float, float]) -> np.ndarray:
    """What every set of a pixel's samples is, by the set as bits, sample 0 the lowest.

    Args:
        samples: Samples of a pixel, across and down each.
        size: Width and height of a sample [2^-16 px].

    Returns:
        `Scene.parts`, [2^(samples^2), 3]: their middle from the centre of the pixel, right and
        down [2^-16 px], and the number of samples.
    """
    sets = np.arange(1 << samples**2)
    bits = (sets[:, None] >> np.arange(samples**2)) & 1
    counts = bits.sum(axis=1)
    down, right = np.divmod(np.arange(samples**2), samples) - np.array([[(samples - 1) / 2]])
    middles = bits @ np.stack([right, down], axis=1) / np.maximum(counts, 1)[:, None]
    steps = np.rint(np.float32(middles) * np.float32(size))
    return np.column_stack([steps, counts]).astype(np.int64)


_SAMPLES_IN = """
    int found = 0;
#if defined(__CUDA_ARCH__)
    for (int k = 0; k < SIDE * SIDE; ++k)
        found |= (at[k / SIDE * width + k % SIDE] == triangle) << k;
#else
    typedef int Row __attribute__((ext_vector_type(4), aligned(4)));
    typedef bool Bits __attribute__((ext_vector_type(4)));
    for (int row = 0; row < SIDE; ++row) {
        const Row same = *(const Row*)(at + row * width) == triangle;
        found |= (__builtin_bit_cast(unsigned char, __builtin_convertvector(same, Bits))
            & ((1 << SIDE) - 1)) << (SIDE * row);
    }
#endif
"""
"""Which samples of the pixel `at` lie in `triangle`; reads one sample more than there are."""

_WHOLE_PIXELS = """
    const int triangle = *at, count = SIDE * (begin - k);
    const int* const lower = at + (SIDE - 1) * width;
    int sample = 0;
#if !defined(__CUDA_ARCH__)
    typedef int Ints __attribute__((ext_vector_type(16), aligned(4)));
    typedef bool Bools __attribute__((ext_vector_type(16)));
    for (; sample + 16 <= count; sample += 16) {
        const Ints differing = (*(const Ints*)(at + sample) ^ triangle)
            | (*(const Ints*)(lower + sample) ^ triangle);
        const int bits = __builtin_bit_cast(
            unsigned short, __builtin_convertvector(differing, Bools));
        if (bits) return (sample + __builtin_ctz(bits)) / SIDE;
    }
#endif
    while (sample < count && at[sample] == triangle && lower[sample] == triangle) ++sample;
    return sample / SIDE;
"""
"""How many pixels from `at` on lie in one triangle: one that holds the outermost samples of a pixel
holds those between, as it is convex."""

_LIST_POINTS = """
    const int begin = most < STRETCH ? most : STRETCH, every = (1 << SIDE * SIDE) - 1;
    const int* __restrict const first = (const int*)line + SIDE * column;
    int* __restrict const pixel = (int*)list_out + PIXEL;
    int* __restrict const triangle_of = (int*)list_out + TRIANGLE;
    int* __restrict const right = (int*)list_out + RIGHT;
    int* __restrict const down = (int*)list_out + DOWN;
    int* __restrict const count = (int*)list_out + COUNT;
    auto samples_in = [&](const int* at, int triangle) { SAMPLES_IN return found; };
    auto whole_pixels = [&](const int* at, int k) { WHOLE_PIXELS };
    for (int k = 0; k < begin; ++k) {
        pixel[k] = k;
        triangle_of[k] = first[SIDE * k];
        right[k] = down[k] = 0;
        count[k] = SIDE * SIDE;
    }
    auto stand_for = [&](int point, int samples) {
        const int* const part = (const int*)parts + 3 * samples;
        right[point] = part[0];
        down[point] = part[1];
        count[point] = part[2];
        return samples;
    };
    int end = begin, k = 0;
    while (k < begin && end + SIDE * SIDE <= ROOM) {
        const int* const at = first + SIDE * k;
        const int whole = whole_pixels(at, k);
        k += whole;
        if (whole) continue;
        int left = every ^ stand_for(k, samples_in(at, triangle_of[k]));
        for (int sample = 0; left; ++sample) {
            if (!(left >> sample & 1)) continue;
            const int other = at[sample / SIDE * width + sample % SIDE];
            pixel[end] = k;
            triangle_of[end] = other;
            left ^= stand_for(end++, left & samples_in(at, other));
        }
        ++k;
    }
    for (int spare = end; spare % LANES; ++spare) {
        pixel[spare] = 0;
        triangle_of[spare] = *first;
        stand_for(spare, every);
    }
    return wp::vec_t<3, int>(k, begin, end);
"""


@cache
def point_lister(samples: int) -> Any:
    """A wp.func that lists the points of a stretch of a row.

    Args:
        samples: Samples of a pixel, across and down each, at most 4.
    """
    snippet = _LIST_POINTS.replace("SAMPLES_IN", _SAMPLES_IN)
    snippet = snippet.replace("WHOLE_PIXELS", _WHOLE_PIXELS)
    constants = {
        "SIDE": samples,
        "STRETCH": STRETCH,
        "ROOM": ROOM,
        "LANES": LANES,
        "PIXEL": PIXEL,
        "TRIANGLE": TRIANGLE,
        "RIGHT": RIGHT,
        "DOWN": DOWN,
        "COUNT": COUNT,
    }
    declared = "".join(f"constexpr int {name} = {value};\n" for name, value in constants.items())

    @wp.func_native(declared + snippet)
    def list_points(
        line: wp.uint64,
        width: int,
        column: int,
        most: int,
        parts: wp.uint64,
        list_out: wp.uint64,
    ) -> wp.vec3i:
        """List them; on the way pixels within one triangle are skipped in runs.

        Args:
            line: Address of the triangles of the samples of a row of pixels, `samples` rows.
            width: Samples in a row.
            column: The first pixel.
            most: Pixels to the end of the row.
            parts: Address of `Scene.parts`.
            list_out: Address of the list, LIST numbers.

        Returns:
            Pixels of the stretch, each the first point of itself; begin and end of the others.
        """
        ...

    return list_points
