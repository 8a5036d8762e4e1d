"""The walk of one edge's nine versions side by side, on a CPU.

A register holds the same sum of eight versions, and the ninth goes along in whole numbers. Clang's
vectors say so; of a kernel in Python LLVM finds the half, and takes it apart again in every row.
What is added and what it amounts to is that of `running_sums`, in the narrow layout.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.moments.moment_layout import MomentLayout
from warp_kernels.moments.prefix_tables import BLOCK_ROWS
from warp_kernels.moments.running_sums import running_order
from warp_kernels.moments.variants import EDGE_VERSIONS
from warp_kernels.raster import FRACTION_BITS

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_POWERS = ("x", "square", "x * square")
"""What a row adds for x^0, x^1 and x^2, see `column_power`."""

_SETTLE_AREA = (
    "sums[0] *= sign;",
    """
        const auto c = sums[0], c_2 = sums[1], c_3 = sums[3], m = sums[2];
        const auto y = end * c - m, y_c_2 = end * c_2 - sums[4];
        const auto triple = (2 * c_3 - 3 * c_2 + c) >> 1;
        sums[0] = sign * c;
        sums[1] = sign * (((c_2 - c) >> 1) - middle * c);
        sums[2] = sign * y;
        sums[3] = sign * (triple * THIRD - middle * (c_2 - c - middle * c));
        sums[4] = sign * (((y_c_2 - y) >> 1) - middle * y);
        sums[5] = sign * (end * (y - m) + 2 * sums[5] - m);
    """,
)
"""From running sums of columns to area moments, by the degree, see `area_settler`."""

_WALK = """
    constexpr unsigned ENTRY_BYTES = 16 * DEPTH, COLUMN_BYTES = ENTRY_BYTES * BLOCK_ROWS;
    constexpr long long THIRD = 0xAAAAAAAAAAAAAAABull;  // times 3 is 1 modulo 2^64
    typedef long long Longs __attribute__((vector_size(64)));
    typedef int Ints __attribute__((vector_size(32)));
    typedef unsigned Places __attribute__((vector_size(32)));
    typedef int Words __attribute__((vector_size(16 * DEPTH), aligned(4)));
    typedef long long Color __attribute__((vector_size(32 * DEPTH)));
    typedef long long Four __attribute__((vector_size(32)));

    Longs at, down, signs;
    Places begin, count;
    for (int i = 0; i < 8; ++i) {
        at[i] = position[i];
        down[i] = step[i];
        signs[i] = sign[i];
        begin[i] = row_begin[i];
        count[i] = row_count[i];
    }
    long long last_at = position[8];

    // where a version does not cross the row it reads column 0: nothing lies left of it
    auto limited = [&](auto column, auto crosses) {
        const auto first = column - column, last = first + width;
        column = column < last ? column : last;
        column = column > first ? column : first;
        return crosses ? column : first;
    };
    auto add_area = [](auto (&sums)[AREAS], auto x, auto square) { ADD_AREA };
    Color color[9] = {};
    Four risen[9] = {};
    Longs area[AREAS] = {};
    long long last_area[AREAS] = {};
    for (unsigned row = first_row; row < (unsigned)end_row; ++row) {
        const unsigned long long block = row / BLOCK_ROWS * (width + 1);
        const char* line = (const char*)table + block * COLUMN_BYTES
            + row % BLOCK_ROWS * ENTRY_BYTES;
        const Places column = (Places)limited(
            __builtin_convertvector(at >> FRACTION_BITS, Ints), row - begin < count);
        const unsigned last_column = limited(
            (int)(last_at >> FRACTION_BITS), row - row_begin[8] < (unsigned)row_count[8]);
        const Places place = column * COLUMN_BYTES;
        const unsigned last_place = last_column * COLUMN_BYTES;
        for (int i = 0; i < 9; ++i) {
            const char* entry = line + (i < 8 ? place[i] : last_place);
            color[i] += __builtin_convertvector(*(const Words*)entry, Color);
            risen[i] += __builtin_shufflevector(color[i], color[i], 0, 1, 2, 3);
        }
        add_area(area, __builtin_convertvector(column, Longs),
            __builtin_convertvector(column * column, Longs));
        add_area(last_area, (long long)last_column, (long long)(last_column * last_column));
        // the next block lies too far away for the processor to guess
        const char* next = line + (unsigned long long)(width + 1) * COLUMN_BYTES;
        __builtin_prefetch(next + last_place);
        __builtin_prefetch(next + place[1]);
        __builtin_prefetch(next + place[2]);
        at += down;
        last_at += step[8];
    }

    const long long end = end_row - height / 2, middle = width / 2;
    auto settle_area = [&](auto (&sums)[AREAS], auto sign) { SETTLE_AREA };
    settle_area(area, signs);
    settle_area(last_area, (long long)sign[8]);
    auto write = [](long long* out, Longs sums, long long last) {
        __builtin_memcpy(out, &sums, sizeof(sums));
        out[8] = last;
    };
    auto write_colors = [&](long long* out, auto& sums, int count) {
        #pragma unroll
        for (int k = 0; k < count; ++k) {
            Longs row;
            for (int i = 0; i < 8; ++i) row[i] = sums[i][k];
            write(out + 9 * k, row * signs, sums[8][k] * sign[8]);
        }
    };
    long long* colors = &wp::index(color_out, edge, 0, 0);
    write_colors(colors, color, 4 * DEPTH);
    if (DEPTH > 1) {
        #pragma unroll
        for (int i = 0; i < 9; ++i) {
            risen[i] = end * __builtin_shufflevector(color[i], color[i], 0, 1, 2, 3) - risen[i];
            risen[i][3] = 0;
        }
        write_colors(colors + 9 * 8, risen, 4);
    }
    long long* areas = &wp::index(area_out, edge, 0, 0);
    for (int k = 0; k < AREAS; ++k) write(areas + 9 * k, area[k], last_area[k]);
"""


@cache
def row_walker(layout: MomentLayout) -> Any:
    """A wp.func: the moments left of all versions of an edge; for the narrow layout."""
    steps = running_order(layout.model.area_exponents)
    add_area = "".join(
        f"sums[{term}] += {f'sums[{lower}]' if lower >= 0 else _POWERS[power]}; "
        for term, lower, power in steps
    )
    constants = {
        "DEPTH": layout.depth,
        "AREAS": layout.model.area_count,
        "BLOCK_ROWS": BLOCK_ROWS,
        "FRACTION_BITS": FRACTION_BITS,
    }
    declared = "".join(f"constexpr int {name} = {value};\n" for name, value in constants.items())
    walk = _WALK.replace("SETTLE_AREA", _SETTLE_AREA[layout.model.degree])
    ints = wp.types.vector(length=EDGE_VERSIONS, dtype=wp.int32)
    longs = wp.types.vector(length=EDGE_VERSIONS, dtype=wp.int64)

    @wp.func_native(declared + walk.replace("ADD_AREA", add_area))
    def walk_rows(
        position: longs,
        step: longs,
        row_begin: ints,
        row_count: ints,
        sign: ints,
        first_row: int,
        end_row: int,
        table: wp.uint64,
        width: int,
        height: int,
        edge: int,
        color_out: wp.array3d(dtype=wp.int64),
        area_out: wp.array3d(dtype=wp.int64),
    ):
        """Walk down all rows that any version crosses.

        `position`, `step`, `row_begin` and `sign` are those of `EdgeWalk`, but that all versions
        stand in the first row; `row_count` tells how many rows each crosses.
        """
        ...

    return walk_rows
