"""Textures of one channel with levels of detail, and how shaders look into them."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import warp as wp

from warp_kernels.elementary import binary_log
from warp_kernels.scene.scene import Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

LINE = 64
"""Every level begins at a whole multiple of so many bytes, which the processor fetches at once."""


@dataclass(frozen=True, eq=False)
class Texels:
    """Images of one size, such as the tones of a hatching, at several levels of detail."""

    levels: tuple[np.ndarray, ...]
    """From fine to coarse, each [images, rows, columns] uint8; 255 is white."""

    @classmethod
    def of(cls, images: np.ndarray) -> "Texels":
        """Make coarser levels by halving until a side is a single texel.

        Args:
            images: Brightness, 0 (black) to 1 (white), [images, rows, columns].
        """
        level = np.asarray(images, dtype=np.float64)
        levels = [level]
        while min(level.shape[1:]) > 1:
            rows, columns = (side // 2 * 2 for side in level.shape[1:])
            even = level[:, :rows, :columns]
            level = (even[:, ::2, ::2] + even[:, 1::2, ::2]) / 4
            level = level + (even[:, ::2, 1::2] + even[:, 1::2, 1::2]) / 4
            levels.append(level)
        return cls(tuple(np.rint(255 * np.clip(level, 0, 1)).astype(np.uint8) for level in levels))

    def with_neighbours(self, *, repeats: bool) -> "Texels":
        """Each texel followed by those to its right, below it, and both, as `texture_at` reads it.

        Args:
            repeats: Whether images are tiles, else their borders go on for ever.

        Returns:
            Levels [images, rows, 4 columns].
        """
        return Texels(
            tuple(_in_fours(level, "wrap" if repeats else "edge") for level in self.levels)
        )


def _in_fours(level: np.ndarray, beyond: Literal["wrap", "edge"]) -> np.ndarray:
    """Each texel of one level [images, rows, columns] with its neighbours."""
    more = np.pad(level, ((0, 0), (0, 1), (0, 1)), mode=beyond)
    rows = (more[:, :-1], more[:, 1:])
    fours = [part for row in rows for part in (row[:, :, :-1], row[:, :, 1:])]
    return np.stack(fours, axis=3).reshape(*level.shape[:2], -1)


def pack(textures: list[Texels | None]) -> tuple[np.ndarray, np.ndarray, list[tuple[int, int]]]:
    """Put textures behind each other.

    Args:
        textures: One for each style, or None.

    Returns:
        `Scene.texels` [N] uint8, `Scene.levels` [L, 4], and for every style the number of its
        first level and of its levels.
    """
    texels, table, ranges = [np.zeros(LINE, np.uint8)], [(0, 1, 1, 1)], []
    begin = LINE
    for texture in textures:
        levels = () if texture is None else texture.levels
        ranges.append((len(table), len(levels)))
        for level in levels:
            padding = -level.size % LINE
            texels.append(np.pad(level.reshape(-1), (0, padding)))
            table.append((begin, *level.shape))
            begin += level.size + padding
    return np.concatenate(texels), np.array(table), ranges


@wp.func
def _wrapped(index: int, count: int) -> int:
    """The texel of a tile that stands for one of its repetitions."""
    # the processor divides whole numbers one by one, others sixteen at a time
    rest = index - count * int(wp.floor(float(index) / float(count)))
    rest = wp.where(rest < 0, rest + count, rest)
    return wp.where(rest >= count, rest - count, rest)


@wp.func
def level_at(scene: Scene, table: wp.vec4i, image: int, at: wp.vec2f, repeats: bool) -> float:
    """Brightness of one level, bilinear; see `texture_at`.

    Args:
        scene: Holds the texels.
        table: The level's row of `Scene.levels`.
        image: Number of the image.
        at: Position, right and down; an image is the unit square.
        repeats: Whether the image is a tile.
    """
    rows = table[2]
    columns = columns_of(table)
    x = at[0] * float(columns) - 0.5
    y = at[1] * float(rows) - 0.5
    if not repeats:
        x = wp.clamp(x, 0.0, float(columns - 1))
        y = wp.clamp(y, 0.0, float(rows - 1))
    column = int(wp.floor(x))
    row = int(wp.floor(y))
    right = x - float(column)
    down = y - float(row)
    if repeats:
        column = _wrapped(column, columns)
        row = _wrapped(row, rows)
    # whatever comes of a place that is no number, it is read from the image
    column = wp.clamp(column, 0, columns - 1)
    row = wp.clamp(row, 0, rows - 1)
    texel = (image * rows + row) * columns + column
    # one number of 32 bits for each point: bytes the processor fetches one by one
    fours = wp.array(ptr=scene.texels.ptr, shape=(scene.texels.shape[0] / 4,), dtype=int)
    four = fours[(table[0] >> 2) + texel]
    above = wp.lerp(float(four & 255), float((four >> 8) & 255), right)
    below = wp.lerp(float((four >> 16) & 255), float((four >> 24) & 255), right)
    return wp.lerp(above, below, down) * wp.static(1.0 / 255.0)


@wp.func
def detail_for(scene: Scene, parameters: StyleParameters, footprint: float) -> float:
    """The level of a style's texture whose texels are as large as pixels, between two of them.

    Args:
        scene: Holds the texels.
        parameters: Says which are the style's.
        footprint: Size of an output pixel, as a part of the image's longer side.
    """
    table = level_of(scene, parameters.first_level)
    texels = footprint * float(wp.max(table[2], columns_of(table)))
    last = float(parameters.level_count - 1)
    return wp.clamp(binary_log(wp.max(texels, 1.0e-6)), 0.0, last)


@wp.func
def level_of(scene: Scene, level: int) -> wp.vec4i:
    """A row of `Scene.levels`."""
    table = wp.array(ptr=scene.levels.ptr, shape=(4 * scene.levels.shape[0],), dtype=int)
    first = 4 * level
    return wp.vec4i(table[first], table[first + 1], table[first + 2], table[first + 3])


@wp.func
def columns_of(table: wp.vec4i) -> int:
    """Columns of a level `with_neighbours`, each of which is four numbers.

    Args:
        table: The level's row of `Scene.levels`.
    """
    return table[3] >> 2


@wp.func
def texture_at(
    scene: Scene,
    parameters: StyleParameters,
    image: int,
    at: wp.vec2f,
    detail: float,
    repeats: bool,
) -> float:
    """Brightness of a style's texture, 0 to 1, trilinear; it must know its texels' neighbours.

    Args:
        scene: Holds the texels.
        parameters: Says which are the style's.
        image: Number of the image, such as a tone.
        at: Position, right and down; an image is the unit square.
        detail: See `detail_for`.
        repeats: Whether the image is a tile, else its border goes on for ever; the same as for
            its neighbours.
    """
    last = wp.max(parameters.level_count - 1, 0)
    level = wp.clamp(int(detail), 0, wp.max(last - 1, 0))
    part = detail - float(level)
    # both without a branch, also where one has no weight: many points are looked at together
    finer = level_of(scene, parameters.first_level + level)
    coarser = level_of(scene, parameters.first_level + wp.min(level + 1, last))
    value = (1.0 - part) * level_at(scene, finer, image, at, repeats)
    return value + part * level_at(scene, coarser, image, at, repeats)
