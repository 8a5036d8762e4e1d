"""How styles lie over each other: blend modes, opacity and coverage, bottom to top.

Opacity mixes code values, as painting programs do: half of a colour looks like half of it.
Coverage is a part of an area, so it mixes light: a line keeps its weight wherever it lies between
two rows of pixels, where a mixture of code values would make dark lines thicker and thinner along
their way, like a twisted rope. What light is, `warp_kernels.scene.light` says.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warp_kernels.scene.light import to_code, to_light
from warp_kernels.scene.scene import FIXED, FRACTION_BITS, Sample, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_WHITE = wp.constant(255.0)


@dataclass(frozen=True)
class Coat:
    """One style of a stack, as far as the kernel depends on it."""

    shader: Any
    """Its wp.func `(Scene, StyleParameters, Sample, below: vec4f) -> Ink`."""
    blend: str
    """Its blend mode, a key of `BLENDS`."""
    is_opaque: bool
    """Whether nothing below it shows or is left transparent."""
    covers: bool
    """Whether it leaves no gaps."""
    is_masked: bool = False
    """Whether it is drawn inside of a mask alone."""
    is_followed: bool = False
    """Whether it is drawn on the triangles of a followed region alone."""
    moves: bool = False
    """Whether it is drawn on triangles that are elsewhere than they lie: as much of it as there is
    of them, in the light that falls on them there."""


@wp.func
def blend_normal(below: wp.vec3f, ink: wp.vec3f) -> wp.vec3f:
    """The ink itself."""
    return ink


@wp.func
def blend_multiply(below: wp.vec3f, ink: wp.vec3f) -> wp.vec3f:
    """Darker than both: white ink changes nothing."""
    return wp.cw_mul(below, ink) / _WHITE


@wp.func
def blend_screen(below: wp.vec3f, ink: wp.vec3f) -> wp.vec3f:
    """Lighter than both: black ink changes nothing."""
    return below + ink - wp.cw_mul(below, ink) / _WHITE


@wp.func
def blend_overlay(below: wp.vec3f, ink: wp.vec3f) -> wp.vec3f:
    """Multiplies what is dark below and screens what is light: contrast."""
    dark = 2.0 * blend_multiply(below, ink)
    light = 2.0 * blend_screen(below, ink) - wp.vec3f(_WHITE, _WHITE, _WHITE)
    return wp.vec3f(
        wp.where(below[0] < 127.5, dark[0], light[0]),
        wp.where(below[1] < 127.5, dark[1], light[1]),
        wp.where(below[2] < 127.5, dark[2], light[2]),
    )


BLENDS: dict[str, Any] = {
    "normal": blend_normal,
    "multiply": blend_multiply,
    "screen": blend_screen,
    "overlay": blend_overlay,
}
"""Blend modes by name.

Source: W3C, Compositing and Blending Level 1, Sec. 10.1.
"""


@wp.func
def painted_all_over(below: wp.vec4f, painted: wp.vec4f, coverage: float) -> wp.vec4f:
    """What is painted, by a style that leaves no gaps."""
    return painted


@wp.func
def inked_on_opaque(below: wp.vec4f, painted: wp.vec4f, coverage: float) -> wp.vec4f:
    """What is painted on a part of the area, what lies below on the rest; nothing shows through.

    Without a branch: where a line runs cannot be guessed.
    """
    under = to_light(wp.vec3f(below[0], below[1], below[2]))
    over = to_light(wp.vec3f(painted[0], painted[1], painted[2]))
    color = to_code(under + coverage * (over - under))
    return wp.vec4f(color[0], color[1], color[2], 1.0)


@wp.func
def inked(below: wp.vec4f, painted: wp.vec4f, coverage: float) -> wp.vec4f:
    """The same where something may show through: colour and opacity."""
    opacity = wp.lerp(below[3], painted[3], coverage)
    under = to_light(wp.vec3f(below[0], below[1], below[2]))
    over = to_light(wp.vec3f(painted[0], painted[1], painted[2]))
    light = (1.0 - coverage) * below[3] * under + coverage * painted[3] * over
    color = to_code(light / wp.max(opacity, 1.0e-6))
    return wp.vec4f(color[0], color[1], color[2], opacity)


@wp.func
def lay_on_nothing(below: wp.vec4f, color: wp.vec3f, opacity: float) -> wp.vec4f:
    """The lowest style of all."""
    return wp.vec4f(color[0], color[1], color[2], opacity)


@wp.func
def mask_at(masks: wp.array2d(dtype=wp.uint8), first: int, rows: int, place: wp.vec2i) -> float:
    """A mask at a place [2^-16 px], bilinear, 0 to 1.

    Args:
        masks: All masks.
        first: The first row of this one.
        rows: Its rows.
        place: The place.
    """
    x = place[0] - wp.static(1 << (FRACTION_BITS - 1))
    y = place[1] - wp.static(1 << (FRACTION_BITS - 1))
    right = float(x & wp.static((1 << FRACTION_BITS) - 1)) / FIXED
    down = float(y & wp.static((1 << FRACTION_BITS) - 1)) / FIXED
    share = float(0.0)
    for i in range(2):
        for j in range(2):
            row = first + wp.clamp((y >> wp.static(FRACTION_BITS)) + i, 0, rows - 1)
            column = wp.clamp((x >> wp.static(FRACTION_BITS)) + j, 0, masks.shape[1] - 1)
            weight = wp.where(i == 0, 1.0 - down, down) * wp.where(j == 0, 1.0 - right, right)
            share += weight * float(masks[row, column])
    return share / 255.0


@cache
def stack_of(coats: tuple[Coat, ...]) -> Any:
    """A wp.func `(Scene, array of StyleParameters, Sample) -> vec4f`: colour and opacity.

    Args:
        coats: Bottom to top; below the lowest everything is transparent.
    """
    if not coats:

        @wp.func
        def nothing(
            scene: Scene, parameters: wp.array(dtype=StyleParameters), sample: Sample
        ) -> wp.vec4f:
            """Nothing drawn: transparent."""
            return wp.vec4f()

        return nothing
    top, layer = coats[-1].shader, len(coats) - 1
    below, is_masked = stack_of(coats[:-1]), coats[-1].is_masked
    is_followed, moves = coats[-1].is_followed, coats[-1].moves
    is_lit = moves and coats[-1].blend == "normal"
    on_opaque = any(coat.is_opaque for coat in coats[:-1])
    lay = _laid(coats[-1].blend, on_opaque) if len(coats) > 1 else lay_on_nothing
    cover = inked_on_opaque if on_opaque else inked
    if coats[-1].covers:
        cover = painted_all_over

    @wp.func
    def blended(
        scene: Scene, parameters: wp.array(dtype=StyleParameters), sample: Sample
    ) -> wp.vec4f:
        """The coats below, and the top one over them."""
        under = below(scene, parameters, sample)
        own = parameters[wp.static(layer)]
        ink = top(scene, own, sample, under)
        if wp.static(is_masked):
            row = own.mask * scene.mask_rows
            ink.opacity *= mask_at(scene.masks, row, scene.mask_rows, sample.place)
        if wp.static(is_followed):
            ink.opacity *= float(scene.shares[sample.triangle, own.mask]) / 255.0
        if wp.static(moves):
            ink.opacity *= sample.presence
        if wp.static(is_lit):
            ink.color *= sample.light
        return cover(under, lay(under, ink.color, ink.opacity * own.opacity), ink.coverage)

    return blended


@cache
def _laid(blend: str, over_opaque: bool) -> Callable[..., Any]:
    """A wp.func that lays a colour of some opacity over what is below."""
    mix = BLENDS[blend]

    @wp.func
    def lay_over_opaque(below: wp.vec4f, color: wp.vec3f, opacity: float) -> wp.vec4f:
        """The usual case: nothing is transparent."""
        under = wp.vec3f(below[0], below[1], below[2])
        over = under + opacity * (mix(under, color) - under)
        return wp.vec4f(over[0], over[1], over[2], 1.0)

    @wp.func
    def lay(below: wp.vec4f, color: wp.vec3f, opacity: float) -> wp.vec4f:
        """Where nothing is below there is nothing to blend with: the colour itself."""
        under = wp.vec3f(below[0], below[1], below[2])
        over = color + below[3] * (mix(under, color) - color)
        whole = opacity + below[3] * (1.0 - opacity)
        if whole <= 0.0:
            return below
        seen = (opacity * over + below[3] * (1.0 - opacity) * under) / whole
        return wp.vec4f(seen[0], seen[1], seen[2], whole)

    return lay_over_opaque if over_opaque else lay
