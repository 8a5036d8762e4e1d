"""Shaders of strokes: what a triangle needs to know is worked out once, a pixel then costs little.

The style hands over these numbers, in this order, and colours as light: squares of code values.
"""

import warp as wp

from warp_kernels.scene.light import to_code, to_light
from warp_kernels.scene.scene import (
    Ink,
    Numbers,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    full_ink,
    prepared_for,
)
from warp_kernels.scene.texels import LINE, level_of
from warp_kernels.styles.tones.lookup import STEPS, ink_at, level_for, pair_of
from warp_kernels.styles.tones.tonal_art_map import DARKEST

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

PEN = wp.constant(0)
"""Light of the ink, three numbers."""
PAPER = wp.constant(3)
"""Light of the paper, three numbers."""
TEXELS = wp.constant(6)
"""Texels per px."""
COSINE = wp.constant(7)
"""Of the turn from the base edge."""
SINE = wp.constant(8)
"""The same."""
LIGHTEN = wp.constant(9)
"""How much lighter than the picture ink is laid: 0 to 1."""
COLORED = wp.constant(10)
"""From ink (0) to pencils in the colours of the triangles (1)."""
SEED = wp.constant(11)
"""Chooses the places on the tile."""
OWN = wp.constant(12)
"""1 where the paper of a triangle is its own colour, else 0."""
CONTRAST = wp.constant(13)
"""How dark strokes are there: 0 to 1."""

# Prepared for a triangle: light of its pen, of its paper, then these.
BEGIN = wp.constant(6)
"""Begin of its pair of tones [LINE bytes]."""
SHARE = wp.constant(7)
"""Share of the darker tone."""
SIDE_OF_LEVEL = wp.constant(8)
"""Side of the level of detail [texels]."""
ACROSS = wp.constant(9)
"""Steps on the tile for one px to the right: to the right, then down, with the other sign."""
DOWN = wp.constant(10)
"""The same, down."""
RIGHT_OF_CORNER = wp.constant(11)
"""Where corner 0 lies on the tile [steps]."""
BELOW_CORNER = wp.constant(12)
"""The same, down."""

WHITE = wp.constant(255.0 * 255.0)
"""The most light."""
SHARPNESS = wp.constant(0.75)
"""Texels are about this part of an output pixel: at 1 lines lose more contrast than jaggedness,
at 1/2 four times as many texels pass through the caches."""
BRIGHTEST = wp.constant(5.0)
"""Light of the paper beside coloured pencils, at most, relative to that of the triangle: brighter
slivers would sparkle in dark triangles."""
TINT = wp.constant(0.5)
"""How much of a triangle's colour lies under the strokes of coloured pencils."""
SATURATION = wp.constant(0.3)
"""How much of what could stay blank coloured pencils cover too: the more, the duller they are."""


@wp.struct
class Coloring:
    """How a triangle is drawn."""

    pen: wp.vec3f
    """Light of the strokes."""
    paper: wp.vec3f
    """Light between them."""
    amount: float
    """Part of the paper that strokes cover."""


@wp.func
def white() -> wp.vec3f:
    """Light of white."""
    return wp.vec3f(WHITE, WHITE, WHITE)


@wp.func
def three(numbers: Numbers, first: int) -> wp.vec3f:
    """A colour among numbers."""
    return wp.vec3f(numbers[first], numbers[first + 1], numbers[first + 2])


@wp.func
def brightness_of(color: wp.vec3f) -> float:
    """Its luma, of a colour as of light."""
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


@wp.func
def in_ink(n: Numbers, color: wp.vec3f) -> Coloring:
    """One ink on one paper, the more the darker the triangle is."""
    dark = 1.0 - brightness_of(color) / 255.0
    coloring = Coloring()
    coloring.pen = three(n, PEN)
    coloring.paper = three(n, PAPER)
    coloring.amount = dark * (1.0 - n[LIGHTEN] + n[LIGHTEN] * dark)
    return coloring


@wp.func
def on_own_color(n: Numbers, color: wp.vec3f) -> Coloring:
    """Strokes that multiply the triangle's colour; from afar it is seen unchanged.

    What strokes take away the paper between them gets: both together are the triangle's light,
    but for channels that are too bright to be raised.
    """
    coloring = in_ink(n, color)
    light = to_light(color)
    taken = wp.cw_mul(n[CONTRAST] * light, white() - coloring.pen) / WHITE
    coloring.paper = wp.min(light + coloring.amount * taken, white())
    coloring.pen = wp.max(coloring.paper - taken, wp.vec3f())
    return coloring


@wp.func
def in_pencil(n: Numbers, color: wp.vec3f) -> Coloring:
    """A pencil for each triangle, such that from afar its colour is seen, on tinted paper."""
    light = to_light(color)
    tinted = wp.lerp(three(n, PAPER), light, TINT)
    coloring = Coloring()
    brightest = BRIGHTEST * brightness_of(light)
    coloring.paper = wp.min(1.0, brightest / wp.max(brightness_of(tinted), 1.0)) * tinted
    kept = wp.cw_div(light, wp.max(coloring.paper, wp.vec3f(1.0, 1.0, 1.0)))
    least = 1.0 - wp.min(wp.min(kept[0], kept[1]), wp.min(kept[2], 1.0))
    coloring.amount = wp.clamp(wp.lerp(least, 1.0, SATURATION), 0.02, DARKEST)
    missing = (coloring.paper - light) / coloring.amount
    coloring.pen = wp.max(coloring.paper - missing, wp.vec3f())
    return coloring


@wp.func
def coloring_of(n: Numbers, color: wp.vec3f) -> Coloring:
    """Between ink and coloured pencils."""
    coloring = in_ink(n, color)
    if n[OWN] > 0.0:
        coloring = on_own_color(n, color)
    if n[COLORED] > 0.0:
        pencil = in_pencil(n, color)
        coloring.pen = wp.lerp(coloring.pen, pencil.pen, n[COLORED])
        coloring.paper = wp.lerp(coloring.paper, pencil.paper, n[COLORED])
        coloring.amount = wp.lerp(coloring.amount, pencil.amount, n[COLORED])
    return coloring


@wp.func
def place_of_centre(scene: Scene, triangle: int, seed: float) -> wp.vec2f:
    """Where the centre of a triangle with new strokes lies on the tile [sides]: anywhere.

    Else triangles that are smaller than a tile would all show the same strokes.
    """
    number = (scene.lay_hashes[triangle] ^ wp.uint32(seed)) * wp.uint32(747796405)
    right = float(int(number >> wp.uint32(23)))
    down = float(int((number >> wp.uint32(14)) & wp.uint32(511)))
    return wp.vec2f(right, down) / 512.0


@wp.func
def prepare_strokes(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Fill `Scene.prepared`."""
    n = parameters.numbers
    coloring = coloring_of(n, color_of(scene, triangle))
    pair = pair_of(coloring.amount)
    level = level_for(n[TEXELS] * scene.pixel * SHARPNESS, parameters.level_count)
    table = level_of(scene, parameters.first_level + level)
    side = table[2]
    edge = wp.vec2f(scene.lay[triangle, 0], scene.lay[triangle, 1])
    steps = n[TEXELS] * wp.static(float(STEPS)) / float(1 << level)
    across = steps * (edge[0] * n[COSINE] - edge[1] * n[SINE])
    down = steps * (edge[0] * n[SINE] + edge[1] * n[COSINE])
    centre = wp.vec2f(scene.lay[triangle, 2], scene.lay[triangle, 3])
    place = float(side * STEPS) * place_of_centre(scene, triangle, n[SEED])
    half = wp.static(0.5 * STEPS)
    result = Numbers()
    for i in range(3):
        result[i] = coloring.pen[i]
        result[3 + i] = coloring.paper[i]
    result[BEGIN] = float(table[0] / LINE + int(pair[0]) * (8 * side * side / LINE))
    result[SHARE] = pair[1]
    result[SIDE_OF_LEVEL] = float(side)
    result[ACROSS] = across
    result[DOWN] = down
    result[RIGHT_OF_CORNER] = place[0] - half - centre[0] * across - centre[1] * down
    result[BELOW_CORNER] = place[1] - half + centre[0] * down - centre[1] * across
    return result


@wp.func
def covered_at(scene: Scene, n: Numbers, offset: wp.vec2f) -> float:
    """Part of the paper that is covered at a point of a prepared triangle."""
    x = int(n[RIGHT_OF_CORNER] + offset[0] * n[ACROSS] + offset[1] * n[DOWN])
    y = int(n[BELOW_CORNER] - offset[0] * n[DOWN] + offset[1] * n[ACROSS])
    return ink_at(scene, int(n[BEGIN]), int(n[SIDE_OF_LEVEL]), n[SHARE], x, y)


@wp.func
def strokes_on_paper(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """Strokes and the paper that they are drawn on."""
    n = prepared_for(scene, parameters, sample.triangle)
    paper = three(n, PAPER)
    covered = covered_at(scene, n, sample.offset)
    return full_ink(to_code(paper + covered * (three(n, PEN) - paper)))


@wp.func
def strokes_alone(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """Strokes on what lies below."""
    n = prepared_for(scene, parameters, sample.triangle)
    ink = Ink()
    ink.color = to_code(three(n, PEN))
    ink.opacity = 1.0
    ink.coverage = covered_at(scene, n, sample.offset)
    return ink
