"""Triangles that are drawn elsewhere than they lie: on the host, and how a shader finds back.

A moved triangle is shaded where it rests: every point of it is carried back to where its material
lies in the mesh, and styles see that place. So strokes, textures, gradients, masks and the source
picture go with their triangle, whatever the style. Rows of a moved frame are sorted so that what
is nearer to the eye comes later, and row 0 is the hole: what is seen where no triangle is.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.drawing.layers import Layers
from warp_kernels.drawing.paint import Paint, joined_paint
from warp_kernels.drawing.pieces import within_reach
from warp_kernels.limits import MAX_SIDE
from warp_kernels.scene.places import to_places
from warp_kernels.scene.scene import FIXED, Sample, Scene, anchor_of, sample_at
from warp_kernels.scene.stroke_lay import Lay

wp.set_module_options(EXACT)

MAP = 7
"""Numbers of a row of `MovedTables.maps`."""
FARTHEST = 32_000.0
"""Triangles with a corner farther away than this are not drawn: places are 32 bits [px]."""
LEAST_AREA = 1e-3
"""Triangles that are drawn with less than twice this area cover nothing [px^2]."""


@dataclass(frozen=True, eq=False)
class Moved:
    """Where the triangles of a frame are drawn, and how."""

    corners: np.ndarray
    """Positions of their corners [px of the picture], [T, 3, 2]."""
    presence: np.ndarray
    """How much of them there is, 0 for nothing, 1 for all, [T]."""
    light: np.ndarray
    """How much brighter they are than at rest, as a factor, [T]."""
    depths: np.ndarray
    """How near they are: where they overlap, the larger number is seen, [T]."""


@wp.struct
class MovedTables:
    """The same on the device, of all rows."""

    anchors: wp.array(dtype=wp.vec2i)
    """Where corner 0 of every triangle is drawn [2^-16 px], [M]."""
    maps: wp.array2d(dtype=float)
    """The way back: what is added to an offset from the anchor, as a matrix less the unit matrix,
    [0:4]; side of what a square of side 1 stands for [4]; presence [5]; light [6]; [M, MAP].
    """


@dataclass(frozen=True, eq=False)
class Rows:
    """All that is drawn of a moved frame, in the order of its rows."""

    vertices: np.ndarray
    """Corners of the triangles, one by one [px of the picture], [3 N, 2]."""
    triangles: np.ndarray
    """Their numbers, [N, 3]."""
    paint: Paint
    """The hole, the N - 1 triangles, then the vanished ones that show through; [M]."""
    layers: Layers | None
    """What fading triangles let through."""
    anchors: np.ndarray
    """See `MovedTables`, [M, 2]."""
    maps: np.ndarray
    """See `MovedTables`, [M, MAP]."""


def rows_of(
    moved: Moved, paint: Paint, layers: Layers | None, picture: tuple[int, int], reach: float
) -> Rows:
    """Sort a frame's triangles by depth, leave out what cannot be seen, and add the hole.

    Args:
        moved: Where the T triangles of the frame are drawn.
        paint: These, then the vanished ones that show through.
        layers: What fading triangles let through, or None.
        picture: Width and height of the picture [px].
        reach: How far outside of it a corner may be [px]; what is larger is drawn in pieces.
    """
    count = len(moved.corners)
    order = _visible(moved, paint.ids[:count])
    pieces, drawn = within_reach(moved.corners[order], picture, reach)
    order = order[pieces]
    rows = np.concatenate([order, np.arange(count, len(paint.ids))])
    corners = np.concatenate([np.zeros((1, 3, 2)), drawn])
    anchors, maps = _way_back(moved, paint.corners[rows], order)
    return Rows(
        corners.reshape(-1, 2),
        np.arange(3 * len(corners)).reshape(-1, 3),
        joined_paint([_hole(paint, picture), paint.of(rows)]),
        None if layers is None else _sorted(layers, rows, len(order) + 1 - count),
        anchors,
        maps,
    )


def _visible(moved: Moved, ids: np.ndarray) -> np.ndarray:
    """Numbers of the triangles that can be seen, the farthest first; of two as near the older."""
    sides = moved.corners[:, 1:] - moved.corners[:, :1]
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    near = (np.abs(moved.corners) < FARTHEST).all(axis=(1, 2))
    seen = np.flatnonzero((area > LEAST_AREA) & (moved.presence > 0.0) & near)
    return seen[np.lexsort((ids[seen], moved.depths[seen]))]


def _way_back(moved: Moved, rest: np.ndarray, order: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Anchors and maps of all rows; the hole and vanished triangles are where they are.

    Args:
        moved: Where triangles are drawn.
        rest: Where the triangles of all rows but the hole lie [px], [M - 1, 3, 2].
        order: Numbers of those that are drawn, [N - 1].
    """
    count = len(order)
    anchors = np.concatenate([np.zeros((1, 2)), rest[:, 0]])
    anchors[1 : count + 1] = moved.corners[order, 0]
    maps = np.zeros((len(anchors), MAP), np.float32)
    maps[:, 4:] = 1.0
    maps[0, 5] = 0.0
    own = slice(1, count + 1)
    # columns are sides: the map takes those of what is drawn to those of what rests
    drawn = (moved.corners[order, 1:] - moved.corners[order, :1]).transpose(0, 2, 1)
    sides = (rest[:count, 1:] - rest[:count, :1]).transpose(0, 2, 1)
    linear = sides @ np.linalg.inv(drawn)
    maps[own, :4] = (linear - np.eye(2)).reshape(-1, 4)
    maps[own, 4] = np.sqrt(
        np.abs(linear[:, 0, 0] * linear[:, 1, 1] - linear[:, 0, 1] * linear[:, 1, 0])
    )
    maps[own, 5] = moved.presence[order]
    maps[own, 6] = moved.light[order]
    return to_places(anchors), maps


def _hole(paint: Paint, picture: tuple[int, int]) -> Paint:
    """A row for what is seen where no triangle is: as large as the picture, black."""
    width, height = picture
    corners = np.array([[[0.0, 0.0], [2.0 * width, 0.0], [0.0, 2.0 * height]]])
    ids = np.array([-1])
    lay = Lay(ids, np.array([[1.0, 0.0]]), corners.mean(axis=1))
    return Paint(
        np.zeros((1, 3)),
        np.zeros((1, 2, 3)),
        None if paint.curvatures is None else np.zeros((1, 4, 3)),
        np.array([[[0.0] * 3, [255.0] * 3]]),
        corners,
        ids,
        None if paint.shares is None else np.zeros((1, paint.shares.shape[1]), np.uint8),
        None if paint.lay is None else lay,
    )


def _sorted(layers: Layers, rows: np.ndarray, shift: int) -> Layers:
    """Layers in the order of the rows; the hole fades never.

    Args:
        layers: What fading triangles let through.
        rows: For every row but the hole the layer that it was, [M - 1].
        shift: By how much the numbers of vanished triangles have grown: links name no others.
    """
    own = np.concatenate([[0], rows])
    weights = layers.weights[own]
    weights[0] = 1.0
    return replace(
        layers,
        weights=weights,
        turns=layers.turns[own],
        departures=layers.departures[own],
        spans=layers.spans[own],
        links=(layers.links + shift).astype(np.int32),
    )


@wp.func
def carried_back(maps: wp.array(dtype=float), triangle: int, x: float, y: float) -> wp.vec2f:
    """What is added to an offset [px] from where a triangle is drawn to where it lies.

    Beyond the triangle a needle's map leads anywhere: no farther than places can be.
    """
    first = wp.static(MAP) * triangle
    right = maps[first] * x + maps[first + 1] * y
    down = maps[first + 2] * x + maps[first + 3] * y
    far = wp.static(float(MAX_SIDE))
    return wp.vec2f(wp.clamp(right, -far, far), wp.clamp(down, -far, far))


@wp.func
def rest_sample(
    scene: Scene,
    moved: MovedTables,
    triangle: int,
    place: wp.vec2i,
    middle: wp.vec2i,
    extent: float,
) -> Sample:
    """The point of a triangle that is drawn at a place [2^-16 px], where it rests.

    Args:
        scene: Knows where triangles lie.
        moved: Where they are drawn.
        triangle: The one that is drawn there.
        place: The place.
        middle: The middle of its pixel.
        extent: Side of the square that the point stands for [px of the picture].
    """
    anchors = wp.array(ptr=moved.anchors.ptr, shape=(2 * moved.anchors.shape[0],), dtype=int)
    length = wp.static(MAP) * moved.maps.shape[0]
    maps = wp.array(ptr=moved.maps.ptr, shape=(length,), dtype=float)
    anchor = anchor_of(scene, triangle)
    left = anchors[2 * triangle]
    top = anchors[2 * triangle + 1]
    x = float(place[0] - left) / FIXED
    y = float(place[1] - top) / FIXED
    more = carried_back(maps, triangle, x, y)
    here = Sample()
    here.triangle = triangle
    here.offset = wp.vec2f(x + more[0], y + more[1])
    here.place = wp.vec2i(
        place[0] - left + anchor[0] + int(wp.rint(FIXED * more[0])),
        place[1] - top + anchor[1] + int(wp.rint(FIXED * more[1])),
    )
    x = float(middle[0] - left) / FIXED
    y = float(middle[1] - top) / FIXED
    more = carried_back(maps, triangle, x, y)
    here.middle = wp.vec2i(
        middle[0] - left + anchor[0] + int(wp.rint(FIXED * more[0])),
        middle[1] - top + anchor[1] + int(wp.rint(FIXED * more[1])),
    )
    here.extent = extent * maps[wp.static(MAP) * triangle + 4]
    here.presence = maps[wp.static(MAP) * triangle + 5]
    here.light = maps[wp.static(MAP) * triangle + 6]
    return here


@wp.func
def own_sample(
    scene: Scene,
    moved: MovedTables,
    triangle: int,
    place: wp.vec2i,
    middle: wp.vec2i,
    extent: float,
) -> Sample:
    """The same where every triangle is drawn where it lies."""
    here = sample_at(scene, triangle, place)
    here.middle = middle
    here.extent = extent
    return here


def resting(moves: bool) -> Any:
    """The wp.func that finds what is seen at a place, `own_sample` or `rest_sample`.

    Args:
        moves: Whether triangles are drawn elsewhere than they lie.
    """
    return rest_sample if moves else own_sample


@wp.kernel(enable_backward=False)
def clear_rows(
    span: wp.array(dtype=wp.vec2i),
    # In:
    samples: int,
    # Out:
    triangle_out: wp.array2d(dtype=int),
):
    """Let the hole be everywhere in the samples of one row of pixels."""
    row = span[0][0] + wp.tid()
    if row < span[0][1]:
        for i in range(samples):
            for column in range(triangle_out.shape[1]):
                triangle_out[row * samples + i, column] = 0


def record_clear(
    device: Device, *, samples: int, smallest_part: int, triangle_out: wp.array
) -> Phase:
    """Prepare the launch that empties a band before moved triangles are filled into it.

    Args:
        device: Where to run.
        samples: Sample rows per row of pixels.
        smallest_part: Rows of pixels that are worth a thread, as for what fills the band.
        triangle_out: Triangle of each sample of a band, [rows, columns] int32.
    """
    return device.record(
        clear_rows, [samples], [triangle_out], smallest_part=smallest_part, flows_on=True
    )
