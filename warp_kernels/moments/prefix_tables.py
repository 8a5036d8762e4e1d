"""Row prefix sums of the image's moment densities: built once per frame, read along every edge.

Entry (row, column, power) is the 4-vector of the sums over all pixels left of `column` in `row`
of x^power I for red, green and blue; the fourth component holds the sum of I^2 for power 0 and
nothing otherwise. In the wide layout all of these are weighted, and the components that are left
hold the sums of w x^a, see `MomentLayout.area_words`. The table is one flat array of blocks of
`BLOCK_ROWS` rows. Within a block the entries of one column follow each other: an edge that runs
down finds several rows in one cache line and in one page of memory.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import SQUARE
from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.moments.moment_layout import ENTRY, MomentLayout, moment_types

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


BLOCK_ROWS = 4
"""Rows whose entries of one column lie side by side: 64 bytes, a cache line, for power 0 alone."""

_BLOCK = wp.constant(BLOCK_ROWS)


def table_length(width: int, height: int, layout: MomentLayout) -> int:
    """Entries of the table of a picture of that size [px], the last block filled up."""
    return -(-height // BLOCK_ROWS) * BLOCK_ROWS * (width + 1) * layout.depth


@wp.func
def table_entry(row: int, column: int, width: int, depth: int) -> int:
    """Place of the first entry of a row and column in the table of a picture `width` px wide."""
    block = row / _BLOCK
    return ((block * (width + 1) + column) * _BLOCK + row - block * _BLOCK) * depth


_SUM_BLOCK = """
    // of the last block's rows those beyond the picture are never read
    const wp::vec_t<3, wp::uint8>* rows[BLOCK_ROWS];
    for (int r = 0; r < BLOCK_ROWS; ++r) {
        const int row = block * BLOCK_ROWS + r;
        rows[r] = &wp::index(pixels, row < height ? row : height - 1, 0);
    }
    int* out = (int*)table + block * (unsigned long long)(width + 1) * (BLOCK_ROWS * 4);
#if defined(__CUDA_ARCH__)
    int left[BLOCK_ROWS][4] = {};
#else
    typedef int Words __attribute__((vector_size(16), aligned(4)));
    Words left[BLOCK_ROWS] = {};
#endif
    for (int column = 0; column < width; ++column) {
        for (int r = 0; r < BLOCK_ROWS; ++r, out += 4) {
            const int red = rows[r][column][0], green = rows[r][column][1];
            const int blue = rows[r][column][2];
            const int square = red * red + green * green + blue * blue;
#if defined(__CUDA_ARCH__)
            for (int n = 0; n < 4; ++n) out[n] = left[r][n];
            left[r][0] += red;
            left[r][1] += green;
            left[r][2] += blue;
            left[r][3] += square;
#else
            *(Words*)out = left[r];
            left[r] += Words{red, green, blue, square};
#endif
        }
    }
    for (int r = 0; r < BLOCK_ROWS; ++r)
        for (int n = 0; n < 4; ++n) *out++ = left[r][n];
"""


@wp.func_native(f"constexpr int BLOCK_ROWS = {BLOCK_ROWS};" + _SUM_BLOCK)
def sum_block(
    pixels: wp.array2d(dtype=wp.vec3ub), block: int, table: wp.uint64, width: int, height: int
):
    """Fill the entries of one block of rows: of one colour, in the narrow layout."""
    ...


@wp.kernel(module="unique", module_options=EXACT)
def sum_rows_of_block(
    span: wp.array(dtype=wp.vec2i),
    # In:
    pixels: wp.array2d(dtype=wp.vec3ub),
    weights: wp.array2d(dtype=wp.uint8),
    # Out:
    table_out: wp.array(dtype=wp.vec4i),
):
    """Sum the rows of one block from left to right side by side: whole cache lines are written."""
    block = span[0][0] + wp.tid()
    if block < span[0][1]:
        sum_block(pixels, block, table_out.ptr, pixels.shape[1], pixels.shape[0])


@cache
def _narrow_table_kernel(layout: MomentLayout) -> Any:
    depth = layout.depth

    @wp.kernel(module="unique", module_options=EXACT)
    def sum_row(
        span: wp.array(dtype=wp.vec2i),
        # In:
        pixels: wp.array2d(dtype=wp.vec3ub),
        weights: wp.array2d(dtype=wp.uint8),
        # Out:
        table_out: wp.array(dtype=wp.vec4i),
    ):
        """Sum one row from left to right; weights are not read."""
        row = span[0][0] + wp.tid()
        if row >= span[0][1]:
            return
        width = pixels.shape[1]
        entry = table_entry(row, 0, width, wp.static(depth))
        left = wp.vec4i(0, 0, 0, 0)
        left_x = wp.vec4i(0, 0, 0, 0)
        column = int(0)
        while column <= width:
            table_out[entry] = left
            if wp.static(depth > 1):
                table_out[entry + 1] = left_x
            pixel = pixels[row, wp.min(column, width - 1)]
            red = int(pixel[0])
            green = int(pixel[1])
            blue = int(pixel[2])
            left += wp.vec4i(red, green, blue, red * red + green * green + blue * blue)
            if wp.static(depth > 1):
                left_x += (column - width / 2) * wp.vec4i(red, green, blue, 0)
            entry += wp.static(BLOCK_ROWS * depth)
            column += 1

    return sum_row


@cache
def _wide_table_kernel(layout: MomentLayout) -> Any:
    types = moment_types(layout)
    integer, entry_type = types.integer, types.entry
    depth, degree, area_words = layout.depth, layout.model.degree, layout.area_words
    words_type = wp.types.vector(length=ENTRY * depth, dtype=integer)

    @wp.kernel(module="unique", module_options=EXACT)
    def sum_row(
        span: wp.array(dtype=wp.vec2i),
        # In:
        pixels: wp.array2d(dtype=wp.vec3ub),
        weights: wp.array2d(dtype=wp.uint8),
        # Out:
        table_out: wp.array(dtype=entry_type),
    ):
        """Sum one row from left to right."""
        row = span[0][0] + wp.tid()
        if row >= span[0][1]:
            return
        width = pixels.shape[1]
        entry = table_entry(row, 0, width, wp.static(depth))
        left = words_type()
        column = int(0)
        while column <= width:
            for n in range(wp.static(depth)):
                table_out[entry + n] = entry_type(
                    left[ENTRY * n], left[ENTRY * n + 1], left[ENTRY * n + 2], left[ENTRY * n + 3]
                )
            pixel = pixels[row, wp.min(column, width - 1)]
            factor = integer(weights[row, wp.min(column, width - 1)])
            x = integer(column - width / 2)
            for power in range(wp.static(2 * degree + 1)):
                if wp.static(power <= degree):
                    for channel in range(3):
                        value = integer(pixel[channel])
                        left[wp.static(ENTRY * power) + channel] += factor * value
                        if wp.static(power == 0):
                            left[wp.static(SQUARE)] += factor * value * value
                left[wp.static(area_words[power])] += factor
                factor *= x
            entry += wp.static(BLOCK_ROWS * depth)
            column += 1

    return sum_row


def table_kernel(device: Device, layout: MomentLayout) -> tuple[Any, int]:
    """The kernel that fills the prefix table, and how many rows each of its threads fills."""
    # on CUDA more threads are worth more
    if layout.depth == 1 and not device.is_cuda:
        return sum_rows_of_block, BLOCK_ROWS
    return _row_kernel(layout), 1


def _row_kernel(layout: MomentLayout) -> Any:
    return _wide_table_kernel(layout) if layout.wide else _narrow_table_kernel(layout)


def record_image_tables(
    device: Device,
    layout: MomentLayout,
    *,
    pixels: wp.array,
    weights: wp.array,
    table_out: wp.array,
) -> Phase:
    """Prepare the launch that fills the prefix table of one image.

    Args:
        device: Where to run.
        layout: Fixes the powers of x and the integers.
        pixels: Code values, [H, W] vec3ub.
        weights: Weight of every pixel, [H, W] uint8. Not read in the narrow layout.
        table_out: Prefix sums, [`table_length`] vectors of four integers.

    Source: Lawonn & Guenther (2018), Sec. 4.2 (sums of colours), App. A.
    Deviation: prefix sums along rows take the place of sums over fragments; the paper has no
        weights.
    """
    kernel, rows = table_kernel(device, layout)
    phase = device.record(kernel, [pixels, weights], [table_out])
    phase.resize(-(-pixels.shape[0] // rows))
    return phase
