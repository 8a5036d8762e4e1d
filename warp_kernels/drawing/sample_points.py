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

_BORDERS = """
    const int* const at = first + SIDE * k;
    const int* const lower = at + (SIDE - 1) * width;
    unsigned long long beside = 0, below = 0;
#if !defined(__CUDA_ARCH__)
    typedef int Ints __attribute__((ext_vector_type(16), aligned(4)));
    typedef bool Bools __attribute__((ext_vector_type(16)));
    auto bits = [](Ints differing) -> unsigned long long {
        return __builtin_bit_cast(unsigned short, __builtin_convertvector(differing, Bools));
    };
    if (k + 16 <= begin) {
        for (int sample = 0; sample < 16 * SIDE; sample += 16) {
            const Ints here = *(const Ints*)(at + sample);
            beside |= bits(here ^ *(const Ints*)(at + sample + 1)) << sample;
            below |= bits(here ^ *(const Ints*)(lower + sample)) << sample;
        }
        return below | (beside & WITHIN);
    }
#endif
    for (int sample = 0; sample < 16 * SIDE && sample < SIDE * (begin - k); ++sample) {
        beside |= (unsigned long long)(at[sample] != at[sample + 1]) << sample;
        below |= (unsigned long long)(at[sample] != lower[sample]) << sample;
    }
    return below | (beside & WITHIN);
"""
"""Where triangles differ within the sixteen pixels from `k` on: for every sample of their upper row
a bit whether it differs from the next one of its pixel or from the lowest one below. A pixel
without such a bit lies in one triangle: one that holds the outermost samples holds those between,
as it is convex."""

_LOWEST = """
#if defined(__CUDA_ARCH__)
    return __ffsll(bits) - 1;
#else
    return __builtin_ctzll(bits);
#endif
"""
"""Number of the lowest bit that is set."""

_LIST_POINTS = """
    const int begin = most < STRETCH ? most : STRETCH, every = (1 << SIDE * SIDE) - 1;
    const int* __restrict const first = (const int*)line + SIDE * column;
    int* __restrict const pixel = (int*)list_out + PIXEL;
    int* __restrict const triangle_of = (int*)list_out + TRIANGLE;
    int* __restrict const right = (int*)list_out + RIGHT;
    int* __restrict const down = (int*)list_out + DOWN;
    int* __restrict const count = (int*)list_out + COUNT;
    auto samples_in = [&](const int* at, int triangle) { SAMPLES_IN return found; };
    auto borders = [&](int k) { BORDERS };
    auto lowest = [](unsigned long long bits) { LOWEST };
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
    int end = begin, done = begin;
    for (int sixteen = 0; sixteen < done; sixteen += 16) {
        unsigned long long differing = borders(sixteen);
        while (differing) {
            const int number = lowest(differing) / SIDE, k = sixteen + number;
            if (end + SIDE * SIDE > ROOM) {
                done = k;
                break;
            }
            const int* const at = first + SIDE * k;
            int left = every ^ stand_for(k, samples_in(at, triangle_of[k]));
            while (left) {
                const int sample = lowest(left);
                const int other = at[sample / SIDE * width + sample % SIDE];
                pixel[end] = k;
                triangle_of[end] = other;
                left ^= stand_for(end++, left & samples_in(at, other));
            }
            differing &= ~1ull << (SIDE * number + SIDE - 1);
        }
    }
    for (int spare = end; spare % LANES; ++spare) {
        pixel[spare] = 0;
        triangle_of[spare] = *first;
        stand_for(spare, every);
    }
    return wp::vec_t<3, int>(done, begin, end);
"""


@cache
def point_lister(samples: int) -> Any:
    """A wp.func that lists the points of a stretch of a row.

    Args:
        samples: Samples of a pixel, across and down each, at most 4.
    """
    snippet = _LIST_POINTS.replace("SAMPLES_IN", _SAMPLES_IN)
    snippet = snippet.replace("BORDERS", _BORDERS).replace("LOWEST", _LOWEST)
    within = sum(1 << bit for bit in range(16 * samples) if bit % samples != samples - 1)
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
    declared += f"constexpr unsigned long long WITHIN = {within}ull;\n"

    @wp.func_native(declared + snippet)
    def list_points(
        line: wp.uint64,
        width: int,
        column: int,
        most: int,
        parts: wp.uint64,
        list_out: wp.uint64,
    ) -> wp.vec3i:
        """List them; of pixels within one triangle it is enough to know that they are.

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
