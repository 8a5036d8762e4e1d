"""Textures of one channel with levels of detail, and how shaders look into them."""

from dataclasses import dataclass

import numpy as np
import warp as wp

from warp_kernels.scene import Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

LINE = 64
"""Every level begins at a whole multiple of so many bytes, which the processor fetches at once."""


@dataclass(frozen=True, eq=False)
class Texture:
    """Images of one size, such as the tones of a hatching, at several levels of detail."""

    levels: tuple[np.ndarray, ...]
    """From fine to coarse, each [images, rows, columns] uint8; 255 is white."""

    @classmethod
    def of(cls, images: np.ndarray) -> "Texture":
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


def pack(textures: list[Texture | None]) -> tuple[np.ndarray, np.ndarray, list[tuple[int, int]]]:
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
def _wrapped(index: int, count: int, repeats: bool) -> int:
    """The index itself, or that of the texel that stands for it beyond the border."""
    if repeats:
        # the processor divides whole numbers one by one, others sixteen at a time
        rest = index - count * int(wp.floor(float(index) / float(count)))
        rest = wp.where(rest < 0, rest + count, rest)
        return wp.where(rest >= count, rest - count, rest)
    return wp.clamp(index, 0, count - 1)


@wp.func
def level_at(
    texels: wp.array(dtype=wp.uint8), table: wp.vec4i, image: int, at: wp.vec2f, repeats: bool
) -> float:
    """Brightness of one level, bilinear; see `texture_at`.

    Args:
        texels: Those of all textures.
        table: The level's row of `Scene.levels`.
        image: Number of the image.
        at: Position, right and down; an image is the unit square.
        repeats: Whether the image is a tile.
    """
    x = at[0] * float(table[3]) - 0.5
    y = at[1] * float(table[2]) - 0.5
    column = int(wp.floor(x))
    row = int(wp.floor(y))
    right = x - float(column)
    down = y - float(row)
    first = table[0] + image * table[2] * table[3]
    upper = first + _wrapped(row, table[2], repeats) * table[3]
    lower = first + _wrapped(row + 1, table[2], repeats) * table[3]
    left_column = _wrapped(column, table[3], repeats)
    right_column = _wrapped(column + 1, table[3], repeats)
    above = wp.lerp(float(texels[upper + left_column]), float(texels[upper + right_column]), right)
    below = wp.lerp(float(texels[lower + left_column]), float(texels[lower + right_column]), right)
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
    texels = footprint * float(wp.max(table[2], table[3]))
    last = float(parameters.level_count - 1)
    return wp.clamp(wp.log2(wp.max(texels, 1.0e-6)), 0.0, last)


@wp.func
def level_of(scene: Scene, level: int) -> wp.vec4i:
    """A row of `Scene.levels`."""
    return wp.vec4i(
        scene.levels[level, 0],
        scene.levels[level, 1],
        scene.levels[level, 2],
        scene.levels[level, 3],
    )


@wp.func
def texture_at(
    scene: Scene,
    parameters: StyleParameters,
    image: int,
    at: wp.vec2f,
    detail: float,
    repeats: bool,
) -> float:
    """Brightness of a style's texture, 0 to 1, trilinear.

    Args:
        scene: Holds the texels.
        parameters: Says which are the style's.
        image: Number of the image, such as a tone.
        at: Position, right and down; an image is the unit square.
        detail: See `detail_for`.
        repeats: Whether the image is a tile, else its border goes on for ever.
    """
    last = wp.max(parameters.level_count - 1, 0)
    level = wp.min(int(detail), wp.max(last - 1, 0))
    part = detail - float(level)
    # both without a branch, also where one has no weight: many points are looked at together
    finer = level_of(scene, parameters.first_level + level)
    coarser = level_of(scene, parameters.first_level + wp.min(level + 1, last))
    value = (1.0 - part) * level_at(scene.texels, finer, image, at, repeats)
    return value + part * level_at(scene.texels, coarser, image, at, repeats)
