"""Row prefix sums of the image's moment densities: built once per frame, read along every edge.

Entry (row, column, power) is the 4-vector of the sums over all pixels left of `column` in `row`
of x^power I for red, green and blue; the fourth component holds the sum of I^2 for power 0 and
nothing otherwise. The table is one flat array of blocks of `BLOCK_ROWS` rows. Within a block the
entries of one column follow each other: an edge that runs down finds several rows in one cache
line and in one page of memory.
"""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.color_model import ColorModel
from warp_kernels.device import Device, Phase

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


BLOCK_ROWS = 4
"""Rows whose entries of one column lie side by side: 64 bytes, a cache line, for power 0 alone."""

_BLOCK = wp.constant(BLOCK_ROWS)


def table_length(width: int, height: int, model: ColorModel) -> int:
    """Entries of the table of a picture of that size [px], the last block filled up."""
    return -(-height // BLOCK_ROWS) * BLOCK_ROWS * (width + 1) * model.table_depth


@wp.func
def table_entry(row: int, column: int, width: int, depth: int) -> int:
    """Place of the first entry of a row and column in the table of a picture `width` px wide."""
    block = row / _BLOCK
    return ((block * (width + 1) + column) * _BLOCK + row - block * _BLOCK) * depth


@cache
def _table_kernel(model: ColorModel) -> Any:
    depth = model.table_depth

    @wp.kernel(enable_backward=False, module="unique")
    def sum_row(
        span: wp.array(dtype=wp.vec2i),
        # In:
        pixels: wp.array2d(dtype=wp.vec3ub),
        # Out:
        table_out: wp.array(dtype=wp.vec4i),
    ):
        """Sum one row from left to right."""
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


def record_image_tables(
    device: Device, model: ColorModel, *, pixels: wp.array, table_out: wp.array
) -> Phase:
    """Prepare the launch that fills the prefix table of one image.

    Args:
        device: Where to run.
        model: Fixes the powers of x.
        pixels: Code values, [H, W] vec3ub.
        table_out: Prefix sums, [`table_length`] vec4i.

    Source: Lawonn & Guenther (2018), Sec. 4.2 (sums of colours), App. A.
    Deviation: prefix sums along rows take the place of sums over fragments.
    """
    phase = device.record(_table_kernel(model), [pixels], [table_out])
    phase.resize(pixels.shape[0])
    return phase
