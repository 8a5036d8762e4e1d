"""How shaders look into tonal art maps.

Neighbouring texels lie together, whatever the direction in which a line of pixels crosses the
tile: blocks of 8 x 4 texels fill one line of the cache. Beside each texel lies that of the next
darker tone, as a shader always needs both.
"""

import numpy as np
import warp as wp

from warp_kernels.scene import Scene
from warp_kernels.texture import LINE, Texture
from warp_kernels.tones.ruling import SIDE
from warp_kernels.tones.tonal_art_map import TONE_STEP, TONES

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

ACROSS, DOWN = 8, 4
"""Columns and rows of a block."""
SMALLEST = 8
"""Side of the coarsest level that is kept: its texels are as wide as the tile has lines."""
STEPS = 256
"""Positions on a tile are whole numbers of so many steps per texel."""
PAIRS = TONES - 1
"""Pairs of a tone and the next darker one."""

_TONE_STEP = wp.constant(TONE_STEP)
_PAIRS = wp.constant(PAIRS)


def packed_tones(tones: np.ndarray) -> Texture:
    """Levels of detail of a tonal art map, in the order in which `ink_at` reads them.

    Args:
        tones: Brightness, [TONES, SIDE, SIDE].

    Returns:
        Levels [PAIRS, side, 2 side] uint8; only their bytes in a row have a meaning.
    """
    levels = (level for level in Texture.of(tones).levels if level.shape[1] >= SMALLEST)
    return Texture(tuple(_packed(level) for level in levels))


def _packed(level: np.ndarray) -> np.ndarray:
    """Blocks of pairs of one level [TONES, side, side]."""
    side = level.shape[1]
    pairs = np.stack([level[:-1], level[1:]], axis=-1)
    blocks = pairs.reshape(PAIRS, side // DOWN, DOWN, side // ACROSS, ACROSS, 2)
    return np.ascontiguousarray(blocks.transpose(0, 1, 3, 2, 4, 5)).reshape(PAIRS, side, 2 * side)


@wp.func
def pair_of(ink: float) -> wp.vec2f:
    """The lighter tone of the two between which an amount of ink lies, and its share of the darker.

    Args:
        ink: Part of the paper, 0 to 1; what exceeds the darkest tone is cut off.
    """
    tone = wp.clamp(ink / _TONE_STEP, 0.0, float(_PAIRS))
    lighter = wp.min(wp.floor(tone), float(_PAIRS - 1))
    return wp.vec2f(lighter, tone - lighter)


@wp.func
def level_for(footprint: float, count: int) -> int:
    """The level of detail whose texels are nearest to pixels in size.

    Args:
        footprint: Size of an output pixel [texels of the finest level].
        count: Levels.
    """
    level = int(0)
    size = float(footprint)
    while size > wp.static(2.0**0.5) and level < count - 1:
        size = 0.5 * size
        level += 1
    return level


@wp.func
def across(column: int) -> int:
    """Where a column's texels are within a row of blocks [pairs]."""
    return ((column >> 3) << 5) + (column & 7)


@wp.func
def row_of_pairs(scene: Scene, line: int, side: int, row: int) -> wp.array(dtype=wp.uint16):
    """The pairs of a row of texels; see `across`."""
    pairs = (row >> 2) * (4 * side) + ((row & 3) << 3)
    begin = scene.texels.ptr + wp.uint64(wp.static(LINE)) * wp.uint64(line)
    # a plain array: its index is never negative and its stride is known
    return wp.array(ptr=begin + wp.uint64(2 * pairs), shape=(4 * side,), dtype=wp.uint16)


@wp.func
def apart(pair: wp.uint16) -> wp.uint32:
    """Both texels of a pair, each in 16 bits of its own."""
    both = wp.uint32(pair)
    return (both | (both << wp.uint32(8))) & wp.uint32(0x00FF00FF)


@wp.func
def mixed_pairs(a: wp.uint32, b: wp.uint32, part: wp.uint32) -> wp.uint32:
    """Both texels between those of two pairs, `part` / 256 of the way, times 256."""
    return a * (wp.uint32(256) - part) + b * part


@wp.func
def halfway(pairs: wp.uint32) -> wp.uint32:
    """Both texels divided by 256 and rounded."""
    return ((pairs + wp.uint32(0x00800080)) >> wp.uint32(8)) & wp.uint32(0x00FF00FF)


@wp.func
def ink_at(scene: Scene, line: int, side: int, part: float, x: int, y: int) -> float:
    """Part of the paper that is inked, 0 to 1: between two tones, bilinear.

    Whole numbers, and two texels at a time: this is most of what a pixel of hatching costs.

    Args:
        scene: Holds the texels.
        line: Begin of the pair of tones in the level of detail [LINE bytes].
        side: Side of the level [texels].
        part: Share of the darker tone.
        x: Position to the right on the tile and its repetitions, from the first texel's centre
            [STEPS per texel of the level].
        y: The same down.
    """
    # the second mask says the same and tells the compiler that no index is negative
    mask = (side - 1) & wp.static(SIDE - 1)
    left = across((x >> 8) & mask)
    next = across(((x >> 8) + 1) & mask)
    upper = row_of_pairs(scene, line, side, (y >> 8) & mask)
    lower = row_of_pairs(scene, line, side, ((y >> 8) + 1) & mask)
    right = wp.uint32(x & 255)
    above = halfway(mixed_pairs(apart(upper[left]), apart(upper[next]), right))
    below = halfway(mixed_pairs(apart(lower[left]), apart(lower[next]), right))
    both = mixed_pairs(above, below, wp.uint32(y & 255))
    lighter = float(int(both & wp.uint32(0xFFFF)))
    darker = float(int(both >> wp.uint32(16)))
    return 1.0 - (lighter + part * (darker - lighter)) * wp.static(1.0 / (255.0 * 256.0))
