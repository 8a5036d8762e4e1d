"""How shaders look into tonal art maps: all that a pixel needs is one number of 64 bits.

It holds two tones, as a shader always needs a tone and the next darker one, of a texel and of
those to its right, below it, and both; whole numbers then mix several of them at a time. Blocks
of 4 x 2 texels fill a line of the cache, so that it serves lines of pixels in any direction.
"""

import numpy as np
import warp as wp

from warp_kernels.scene.scene import Scene
from warp_kernels.scene.texels import LINE, Texels
from warp_kernels.styles.tones.tonal_art_map import TONE_STEP, TONES

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

ACROSS, DOWN = 4, 2
"""Columns and rows of a block."""
SMALLEST = 8
"""Side of the coarsest level that is kept: its texels are as wide as the tile has lines."""
STEPS = 256
"""Positions on a tile are whole numbers of so many steps per texel."""
SOFTNESS = 0.1
"""Part of its ink that a texel gives to each of its four neighbours. Between two texels a line
that is as thin as one would else be half as dark as on one of them: slanted lines would be rows of
beads, which run along the lines as these move."""
PAIRS = TONES - 1
"""Pairs of a tone and the next darker one."""

_BYTES = wp.constant(wp.uint64(0x00FF00FF00FF00FF))
"""The lower bytes of four numbers of 16 bits."""
_WORDS = wp.constant(wp.uint64(0x0000FFFF0000FFFF))
"""Those of two numbers of 32 bits."""
_HALVES = wp.constant(wp.uint64(0x0080008000800080))
"""1/2 in each of four numbers that are divided by 256."""
_TONE_STEP = wp.constant(TONE_STEP)
_PAIRS = wp.constant(PAIRS)


def packed_tones(tones: np.ndarray) -> Texels:
    """Levels of detail of a tonal art map, in the order in which `ink_at` reads them.

    Args:
        tones: Brightness, [TONES, SIDE, SIDE].

    Returns:
        Levels [PAIRS, side, 8 side] uint8.
    """
    levels = (level for level in Texels.of(tones).levels if level.shape[1] >= SMALLEST)
    return Texels(tuple(_packed(softened(level)) for level in levels))


def softened(level: np.ndarray) -> np.ndarray:
    """Images of tiles [images, side, side] uint8 with ink that has run a little."""
    soft = level.astype(np.float64)
    for axis in (1, 2):
        beside = np.roll(soft, 1, axis) + np.roll(soft, -1, axis)
        soft = (1.0 - 2.0 * SOFTNESS) * soft + SOFTNESS * beside
    return np.rint(soft).astype(np.uint8)


def _packed(level: np.ndarray) -> np.ndarray:
    """Each texel of one level [TONES, side, side] with its neighbours, in two tones."""
    side = level.shape[1]
    packed = np.empty((PAIRS, side, side, 2, 2, 2), dtype=np.uint8)
    for below in (0, 1):
        for right in (0, 1):
            neighbour = np.roll(level, (-below, -right), axis=(1, 2))
            for darker in (0, 1):
                packed[:, :, :, below, right, darker] = neighbour[darker : darker + PAIRS]
    blocks = packed.reshape(PAIRS, side // DOWN, DOWN, side // ACROSS, ACROSS, 8)
    return np.ascontiguousarray(blocks.swapaxes(2, 3)).reshape(PAIRS, side, 8 * side)


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
def apart(bytes: wp.uint32) -> wp.uint64:
    """Four bytes, each in 16 bits of its own."""
    words = (wp.uint64(bytes) | (wp.uint64(bytes) << wp.uint64(16))) & _WORDS
    return (words | (words << wp.uint64(8))) & _BYTES


@wp.func
def between(a: wp.uint64, b: wp.uint64, part: int) -> wp.uint64:
    """Numbers of 16 bits that are bytes, `part` / STEPS of the way from a to b, times STEPS."""
    return a * wp.uint64(STEPS - part) + b * wp.uint64(part)


@wp.func
def ink_at(scene: Scene, begin: int, side: int, part: float, x: int, y: int) -> float:
    """Part of the paper that is inked, 0 to 1: between two tones, bilinear.

    Args:
        scene: Holds the texels.
        begin: Begin of the pair of tones in the level of detail [LINE bytes].
        side: Side of the level [texels].
        part: Share of the darker tone.
        x: Position to the right on the tile and its repetitions, from the first texel's centre
            [STEPS per texel of the level].
        y: The same down.
    """
    mask = side - 1
    row = (y >> 8) & mask
    column = (x >> 8) & mask
    texel = (row >> 1) * (2 * side) + ((column >> 2) << 3) + ((row & 1) << 2) + (column & 3)
    address = scene.texels.ptr + wp.uint64(wp.static(LINE)) * wp.uint64(begin)
    found = wp.array(ptr=address + wp.uint64(8 * texel), shape=(1,), dtype=wp.uint64)
    four = found[0]
    rows = between(apart(wp.uint32(four)), apart(wp.uint32(four >> wp.uint64(32))), y & 255)
    whole = ((rows + _HALVES) >> wp.uint64(8)) & _BYTES
    both = between(wp.uint64(wp.uint32(whole)), whole >> wp.uint64(32), x & 255)
    lighter = float(int(both & wp.uint64(0xFFFF)))
    darker = float(int(both >> wp.uint64(16)))
    return 1.0 - (lighter + part * (darker - lighter)) * wp.static(1.0 / (255.0 * STEPS))
