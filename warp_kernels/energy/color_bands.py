"""Which triangles may show a colour that nothing near by has, told from bands of rows.

A pixel of a band of four rows has at least six rows of its surroundings in common with the others
of its column there. What the darkest and the brightest of these allow, all of them allow: two small
pictures of such ranges are looked at instead of every pixel, and few triangles are left.
"""

import numpy as np
import warp as wp

from warp_kernels.color_model import CHANNELS
from warp_kernels.device.exact import EXACT
from warp_kernels.energy.nearby_colors import LEEWAY, NEAR, Bytes, bytes_around
from warp_kernels.energy.triangle_look import Column, TriangleLook
from warp_kernels.energy.triangle_walk import columns_of, step_down, walk_triangle
from warp_kernels.energy.workspace import Workspace

wp.set_module_options(EXACT)

BAND = 4
"""Rows of a band."""
SHARED = NEAR + 1 - BAND
"""Rows above and below a band that are near to all its pixels of a column."""
CHUNK = 64
"""Columns that are worked on at once."""


@wp.func_native("""
    const int first = begin - 4 > 0 ? begin - 4 : 0;
    const int last = begin + 68 < width ? begin + 68 : width;
    const int end = begin + 64 < width ? begin + 64 : width;
    unsigned char low[288], high[288];
    for (int i = 0; i < 288; ++i) { low[i] = 255; high[i] = 0; }
    const int shift = 3 * (first - begin + 4);
    for (int row = top; row < bottom; ++row) {
        const size_t place = (size_t)row * width + first;
        const unsigned char* line = (const unsigned char*)pixels + 3 * place;
        for (int i = 0; i < 3 * (last - first); ++i) {
            const unsigned char value = line[i];
            low[shift + i] = value < low[shift + i] ? value : low[shift + i];
            high[shift + i] = value > high[shift + i] ? value : high[shift + i];
        }
    }
    // windows of two, four, eight and nine columns
    const int steps[4] = {3, 6, 12, 3};
    for (int n = 0; n < 4; ++n) {
        unsigned char narrow[288], small[288];
        for (int i = 0; i < 288; ++i) { narrow[i] = low[i]; small[i] = high[i]; }
        for (int i = 0; i < 240; ++i) {
            const unsigned char further = narrow[i + steps[n]], other = small[i + steps[n]];
            low[i] = further < narrow[i] ? further : narrow[i];
            high[i] = other > small[i] ? other : small[i];
        }
    }
    unsigned char* darkest = (unsigned char*)low_out + 3ull * ((size_t)band * width + begin);
    unsigned char* brightest = (unsigned char*)high_out + 3ull * ((size_t)band * width + begin);
    for (int i = 0; i < 3 * (end - begin); ++i) { darkest[i] = low[i]; brightest[i] = high[i]; }
""")
def widen(
    pixels: wp.uint64,
    top: int,
    bottom: int,
    begin: int,
    width: int,
    band: int,
    low_out: wp.uint64,
    high_out: wp.uint64,
):
    """Ranges of some rows and of nine columns around each of a chunk of columns."""
    ...


@wp.func_native("""
    const unsigned char* darkest = (const unsigned char*)low + 3ull * ((size_t)band * width);
    const unsigned char* brightest = (const unsigned char*)high + 3ull * ((size_t)band * width);
    const unsigned char* lower = (const unsigned char*)&least;
    const unsigned char* upper = (const unsigned char*)&most;
    while (column < end) {
        const int stop = column + 16 < end ? column + 16 : end;
#if !defined(__CUDA_ARCH__)
        const int begin = stop - 16;
        if (begin >= 0) {
            typedef unsigned char Bytes __attribute__((vector_size(16)));
            typedef long long Words __attribute__((vector_size(16)));
            Words out = {};
            for (int part = 0; part < 48; part += 16) {
                Bytes dark, bright, floor, ceiling;
                __builtin_memcpy(&dark, darkest + 3 * begin + part, 16);
                __builtin_memcpy(&bright, brightest + 3 * begin + part, 16);
                __builtin_memcpy(&floor, lower + part, 16);
                __builtin_memcpy(&ceiling, upper + part, 16);
                out |= (Words)((dark > ceiling) | (bright < floor));
            }
            if (!(out[0] | out[1])) { column = stop; continue; }
        }
#endif
        for (; column < stop; ++column) {
            for (int c = 0; c < 3; ++c) {
                if (darkest[3 * column + c] > upper[c]) return false;
                if (brightest[3 * column + c] < lower[c]) return false;
            }
        }
    }
    return true;
""")
def all_hold(
    low: wp.uint64,
    high: wp.uint64,
    band: int,
    width: int,
    column: int,
    end: int,
    least: Bytes,
    most: Bytes,
) -> bool:
    """Whether every range of some columns of a band reaches into that between two colours."""
    ...


@wp.kernel(enable_backward=False)
def widen_bands(
    span: wp.array(dtype=wp.vec2i),
    # In:
    pixels: wp.array2d(dtype=wp.vec3ub),
    # Out:
    low_out: wp.array2d(dtype=wp.vec3ub),
    high_out: wp.array2d(dtype=wp.vec3ub),
):
    """Find the ranges of one band."""
    band = span[0][0] + wp.tid()
    if band >= span[0][1]:
        return
    height, width = pixels.shape[0], pixels.shape[1]
    top = wp.max(band * wp.static(BAND) - wp.static(SHARED), 0)
    bottom = wp.min(band * wp.static(BAND) + wp.static(BAND + SHARED), height)
    begin = int(0)
    while begin < width:
        widen(pixels.ptr, top, bottom, begin, width, band, low_out.ptr, high_out.ptr)
        begin += wp.static(CHUNK)


@wp.kernel(enable_backward=False)
def sift(
    span: wp.array(dtype=wp.vec2i),
    # In:
    vertices: wp.array(dtype=wp.vec2d),
    triangles: wp.array(dtype=wp.vec3i),
    low: wp.array2d(dtype=wp.vec3ub),
    high: wp.array2d(dtype=wp.vec3ub),
    height: int,
    coefficients: wp.array3d(dtype=wp.float64),
    energies: wp.array(dtype=wp.float64),
    # Out:
    suspects_out: wp.array(dtype=int),
):
    """Walk down the bands of one triangle."""
    triangle = span[0][0] + wp.tid()
    if triangle >= span[0][1]:
        return
    suspects_out[triangle] = 0
    if energies[triangle] <= wp.float64(wp.static(0.5 * LEEWAY * LEEWAY)):
        return  # not one pixel can be that far off
    color = wp.vec3d(
        coefficients[triangle, 0, 0], coefficients[triangle, 1, 0], coefficients[triangle, 2, 0]
    )
    least, most = bytes_around(color)
    corners = triangles[triangle]
    walk = walk_triangle(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], height)
    begin = low.shape[1]
    end = int(0)
    while walk.row + 1 < walk.end:
        walk = step_down(walk, height)
        columns = columns_of(walk, low.shape[1])
        if columns[0] < columns[1]:
            begin = wp.min(begin, columns[0])
            end = wp.max(end, columns[1])
        is_last = walk.row + 1 == walk.end or (walk.row + 1) % wp.static(BAND) == 0
        if is_last:
            band = walk.row / wp.static(BAND)
            if not all_hold(low.ptr, high.ptr, band, low.shape[1], begin, end, least, most):
                suspects_out[triangle] = 1
                return
            begin = low.shape[1]
            end = int(0)


class Bands:
    """Looks for triangles of one colour each that nearby pixels may not have.

    Args:
        workspace: Holds the picture and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        device, (width, height) = workspace.device, workspace.size
        shape = (-(-height // BAND), width)
        ranges = [device.empty(shape, wp.vec3ub) for _ in range(2)]
        self._widening = device.record(widen_bands, [workspace.pixels], ranges)
        self._widening.resize(shape[0])
        self._look = TriangleLook(
            workspace,
            sift,
            fixed=[*ranges, height],
            given=[Column(wp.float64, (CHANNELS, 1)), Column(wp.float64)],
            found=[Column(int)],
        )

    def suspects(self, coefficients: np.ndarray, energies: np.ndarray) -> np.ndarray:
        """Triangles of the mesh as it stands that are to be looked at pixel by pixel, [T] bool.

        Args:
            coefficients: As in a snapshot, of one term, [T, 3, 1].
            energies: No less than what these leave [code value^2 px], [T].
        """
        given = [coefficients, energies]
        (found,) = self._look.look(len(energies), given, first=[self._widening])
        suspected: np.ndarray = found > 0
        return suspected
