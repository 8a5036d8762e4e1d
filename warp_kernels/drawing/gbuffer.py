"""Which triangle lies under every sample of a band of the output.

A whole output has nine samples a pixel, more than the caches hold; a band fits.

Coverage is that of `raster`: each sample belongs to exactly one triangle, so neither a gap nor a
doubled border can show, and no order of threads matters.
"""

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.drawing.band_lists import BandLists
from warp_kernels.raster import SUBPIXELS, column_of, to_fixed, walk_edge

wp.set_module_options(EXACT)

_UNIT = wp.constant(SUBPIXELS)
BAND_SAMPLES = 1 << 18
"""Samples of a band, for which triangles are found before they are shaded: 1 MB stays in cache."""
LEAST_ROWS = 1
"""Rows of pixels that are worth a thread: bands are so low that with more some would have none."""
CARD_LANES, CARD_STRIPS = 32, 32
"""On a card so many threads fill a row of a triangle, and so many strips of it are filled at once:
a large one would else keep a single thread busy for longer than all others together."""
ONCE = 1 << 30
"""On a card each thread fills one triangle: the next is beyond the list."""


def band_rows(device: Device, output: tuple[int, int], samples: int) -> int:
    """Rows of pixels of a band: on a card, which has no use for bands, all.

    Args:
        device: Where to run.
        output: Width and height [px].
        samples: Samples of a pixel, across and down each.
    """
    width, height = output
    fitting = height if device.is_cuda else BAND_SAMPLES // (width * samples**2)
    return max(1, min(height, fitting))


def fill_threads(device: Device, triangles: int) -> int:
    """Kernel threads that fill so many triangles, see `Phase.resize`: on the CPU one for all."""
    return triangles * CARD_LANES * CARD_STRIPS if device.is_cuda else 1


@wp.func_native("""
    int* const at = (int*)line;
    int column = begin;
#if defined(__CUDA_ARCH__)
    for (column += lane; column < end; column += lanes) {
        if (overlaps) atomicMax(at + column, triangle);
        else at[column] = triangle;
    }
#else
    typedef int Sixteen __attribute__((ext_vector_type(16), aligned(4)));
    typedef int Four __attribute__((ext_vector_type(4), aligned(4)));
    if (end - begin >= 16) {
        for (; column < end - 16; column += 16) *(Sixteen*)(at + column) = triangle;
        *(Sixteen*)(at + end - 16) = triangle;
        return;
    }
    if (end - begin >= 4) {
        for (; column < end - 4; column += 4) *(Four*)(at + column) = triangle;
        *(Four*)(at + end - 4) = triangle;
        return;
    }
    for (; column < end; ++column) at[column] = triangle;
#endif
""")
def fill_run(
    line: wp.uint64, begin: int, end: int, triangle: int, overlaps: int, lane: int, lanes: int
):
    """Fill a part of a row: whole registers, the last of which overlaps the one before.

    On a card `lanes` threads fill it together, neighbours side by side. Where triangles overlap
    the last one is seen; on the CPU it comes last.
    """
    ...


@wp.func
def strip_of(span: wp.vec2i, samples: int, strip: int, strips: int) -> wp.vec2i:
    """First row of samples of a strip of rows of pixels, and its height."""
    rows = (span[1] - span[0]) * samples
    share = (rows + strips - 1) / strips
    return wp.vec2i(span[0] * samples + strip * share, wp.min(share, rows - strip * share))


@wp.func
def downwards(a: wp.vec2i, b: wp.vec2i, c: wp.vec2i):
    """Three corners, the upmost first and the lowest last."""
    top, middle, bottom = a, b, c
    if middle[1] < top[1]:
        swap = top
        top = middle
        middle = swap
    if bottom[1] < top[1]:
        swap = top
        top = bottom
        bottom = swap
    if bottom[1] < middle[1]:
        swap = middle
        middle = bottom
        bottom = swap
    return top, middle, bottom


@wp.func
def fill_strip(
    a: wp.vec2i,
    b: wp.vec2i,
    c: wp.vec2i,
    begin: int,
    height: int,
    triangle: int,
    overlaps: int,
    lane: int,
    lanes: int,
    triangle_out: wp.array2d(dtype=int),
):
    """Fill a strip of one triangle, between its long edge and the two short ones.

    Args:
        a: A corner, from the strip's upper end [1/256 samples].
        b: Another one.
        c: The third.
        begin: First row of the strip.
        height: Its rows.
        triangle: What is written.
        overlaps: See `fill_run`.
        lane: See there.
        lanes: See there.
        triangle_out: Triangle of each sample of a band.
    """
    if wp.max(wp.max(a[1], b[1]), c[1]) < 0 or wp.min(wp.min(a[1], b[1]), c[1]) > height * _UNIT:
        return
    top, middle, bottom = downwards(a, b, c)
    width = triangle_out.shape[1]
    long = walk_edge(top, bottom, height)
    short = walk_edge(top, middle, height)
    row = long.row_begin
    pitch = wp.uint64(width) * wp.uint64(4)
    line = triangle_out.ptr + wp.uint64(begin + row) * pitch
    while row < long.row_end:
        if row >= short.row_end:
            short = walk_edge(middle, bottom, height)
        long_column = column_of(long.position)
        short_column = column_of(short.position)
        column = wp.max(wp.min(long_column, short_column), 0)
        end = wp.min(wp.max(long_column, short_column), width)
        fill_run(line, column, end, triangle, overlaps, lane, lanes)
        long.position += long.step
        short.position += short.step
        line += pitch
        row += 1


@wp.kernel(enable_backward=False)
def fill_triangles(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    listed: wp.array(dtype=int),
    begins: wp.array(dtype=int),
    band: int,
    scale: wp.vec2d,
    first_row: int,
    samples: int,
    overlaps: int,
    lanes: int,
    strips: int,
    stride: int,
    # Out:
    triangle_out: wp.array2d(dtype=int),
):
    """Fill a strip of one triangle of a band, and of every `stride`th after it."""
    strip = strip_of(span[0], samples, wp.tid() / lanes % strips, strips)
    above = wp.vec2i(0, (first_row + strip[0]) * _UNIT)
    lane = wp.tid() % lanes
    n = begins[band] + wp.tid() / lanes / strips
    while n < begins[band + 1]:
        triangle = listed[n]
        corners = triangles[triangle]
        fill_strip(
            to_fixed(wp.cw_mul(vertices[corners[0]], scale)) - above,
            to_fixed(wp.cw_mul(vertices[corners[1]], scale)) - above,
            to_fixed(wp.cw_mul(vertices[corners[2]], scale)) - above,
            strip[0], strip[1], triangle, overlaps, lane, lanes, triangle_out,
        )  # fmt: skip
        n += stride


def record_gbuffer(
    device: Device,
    *,
    vertices: wp.array,
    triangles: wp.array,
    lists: BandLists,
    band: int,
    scale: tuple[float, float],
    first_row: int,
    samples: int,
    triangle_out: wp.array,
    overlaps: bool = False,
) -> Phase:
    """Prepare the launch that writes every sample's triangle; its elements are rows of pixels.

    Every part of it looks at all triangles of the band and fills rows of its own, so that whoever
    shades a row finds it in the cache, and nobody waits for another.

    Args:
        device: Where to run.
        vertices: Positions [px of the picture], [V] vec2d.
        triangles: Corners, [T] vec3i.
        lists: Which triangles lie in which band.
        band: Number of the band.
        scale: Samples per pixel of the picture, across and down.
        first_row: The sample row of the output with which `triangle_out` begins.
        samples: Sample rows per row of pixels.
        triangle_out: Triangle of each sample of a band of the output, [rows, columns] int32;
            across it is the output's width times the samples per output pixel.
        overlaps: Whether triangles may lie over each other: what comes later is seen then, and the
            band was emptied before.
    """
    spread = (CARD_LANES, CARD_STRIPS, ONCE) if device.is_cuda else (1, 1, 1)
    inputs = [vertices, triangles, lists.listed, lists.begins, band]
    inputs += [wp.vec2d(*scale), first_row, samples, int(overlaps), *spread]
    return device.record(
        fill_triangles, inputs, [triangle_out], smallest_part=LEAST_ROWS, flows_on=True
    )
