"""What a style's shader may look at, and what it gives back.

Places in the picture are whole numbers of 2^-16 px, and a shader sees them from a corner of its
triangle: a triangle that is whole pixels further on is drawn the same, to the last bit.
"""

import warp as wp

FRACTION_BITS = 16
"""Places count in 2^-16 px: an eighth-thousandth of what is seen, and 8192 px fit into 32 bits."""
FIXED = wp.constant(float(1 << FRACTION_BITS))
"""Units of a place per px."""

FAR = wp.constant(1.0e30)
"""Farther than any picture is wide [px]."""

Numbers = wp.types.vector(length=16, dtype=wp.float32)
"""A style's numbers, in the order that the style itself fixes; the rest is zero."""


@wp.struct
class StyleParameters:
    """What a style was asked for."""

    numbers: Numbers
    """Its own parameters."""
    opacity: float
    """How much it hides what lies below, 0 to 1; the stack applies it, not the shader."""
    first_level: int
    """Number of its texture's finest level in `Scene.levels`."""
    level_count: int
    """Levels of its texture, 0 if it has none."""
    row: int
    """Its row of `Scene.prepared`."""
    mask: int
    """Number of its mask or of its followed region, if it has one."""


@wp.struct
class Scene:
    """One frame's triangles, as shaders see them."""

    colors: wp.array2d(dtype=float)
    """Mean colour of every triangle [code values], [T, 3]; see `color_of`."""
    gradients: wp.array2d(dtype=wp.vec3f)
    """Change of colour per px to the right and down, at the centre [code values / px], [T, 2]."""
    curvatures: wp.array3d(dtype=float)
    """What a quadratic colour adds to that: its difference from the mean at the centre [code
    values], then the coefficients of x^2, x y and y^2 from there [code values / px^2],
    [T, 4, 3]."""
    curved: wp.array(dtype=int)
    """1 where colours are quadratic, 0 where `curvatures` are not to be read, [1]."""
    limits: wp.array3d(dtype=float)
    """The lowest and the highest values that a triangle may show [code values], [T, 2, 3]."""
    anchors: wp.array(dtype=wp.vec2i)
    """Place of every triangle's corner 0, which starts its base edge [2^-16 px], [T]."""
    sides: wp.array3d(dtype=float)
    """Corners 1 and 2 from corner 0 [px of the picture]; the first is the base edge, [T, 2, 2]; see
    `side_of`."""
    incircles: wp.array2d(dtype=float)
    """Incentre from corner 0 and the inradius [px of the picture], [T, 3]."""
    lines: wp.array(dtype=wp.mat33f)
    """Rows (a, b, c) for the sides from corners 0, 1 and 2 on: a x + b y + c is the distance from
    the side to the inside, (x, y) seen from corner 0 [px of the picture], [T]."""
    hashes: wp.array(dtype=wp.uint32)
    """A number without order for every triangle that stays with it from frame to frame, [T]."""
    lay: wp.array2d(dtype=float)
    """Direction of every triangle's strokes, and from corner 0 where the centre of the triangle
    that they were drawn for would be by now [px], [T, 4]."""
    lay_hashes: wp.array(dtype=wp.uint32)
    """The hash of that triangle, [T]."""
    prepared: wp.array2d(dtype=Numbers)
    """What styles worked out about every triangle beforehand, [styles, T]."""
    source: wp.array2d(dtype=wp.vec3ub)
    """The source picture, smaller by the factor `source_step`; empty unless a style needs it."""
    source_step: int
    """Pixels of the picture, across and down, that are one of `source`."""
    masks: wp.array2d(dtype=wp.uint8)
    """Where masked styles are drawn, 255 for fully; masks of the picture, one below the other."""
    mask_rows: int
    """Rows of a mask."""
    shares: wp.array2d(dtype=wp.uint8)
    """How much every triangle belongs to every followed region, 255 for fully, [T, regions]."""
    texels: wp.array(dtype=wp.uint8)
    """The textures of all styles; see `texture`."""
    levels: wp.array2d(dtype=int)
    """Begin in `texels`, images, rows and columns of every level of every texture, [L, 4]."""
    columns: wp.array(dtype=int)
    """Place of the centre of every output column [2^-16 px], [columns]."""
    rows: wp.array(dtype=int)
    """The same of every output row, [rows]."""
    pixel: float
    """Size of an output pixel [px of the picture]."""
    ground: wp.array2d(dtype=wp.vec3ub)
    """What is seen behind triangles that move, [rows, columns]; empty unless a style needs it."""
    parts: wp.array2d(dtype=int)
    """Every set of samples of a pixel, see `points.parts_of_a_pixel`, [sets, 3]."""


@wp.struct
class Sample:
    """The point that is shaded."""

    triangle: int
    """Number of the triangle under it."""
    offset: wp.vec2f
    """Position, from corner 0 of the triangle [px of the picture]."""
    place: wp.vec2i
    """The same from the picture's upper left [2^-16 px]; to look into `source`, nothing else."""
    extent: float
    """Side of the square that the point stands for, an output pixel or a part of one: a shader
    smooths over it and leaves finer detail out [px of the picture]."""
    row: int
    """Row of the output pixel."""
    column: int
    """Column of the output pixel."""
    middle: wp.vec2i
    """The middle of the output pixel [2^-16 px]; where the triangle is drawn elsewhere than it
    lies, the place of its material that is seen there."""
    presence: float
    """How much of its triangle there is, 0 to 1; looked at where triangles are moved."""
    light: float
    """How much brighter it is than at rest, as a factor; the same."""


@wp.struct
class Ink:
    """What a shader gives back."""

    color: wp.vec3f
    """Colour [code values]."""
    opacity: float
    """How much the ink hides, 0 to 1; mixes code values, as painting programs do."""
    coverage: float
    """Part of the point that is inked at all, 0 to 1; mixes light, as the eye does."""


# What follows reads tables as plain ones of single numbers. The compiler looks many points up at a
# time if it knows the strides, and if no vector is read as a whole: that is two numbers in one.


@wp.func
def color_of(scene: Scene, triangle: int) -> wp.vec3f:
    """Mean colour of a triangle [code values]."""
    table = wp.array(ptr=scene.colors.ptr, shape=(3 * scene.colors.shape[0],), dtype=float)
    return wp.vec3f(table[3 * triangle], table[3 * triangle + 1], table[3 * triangle + 2])


@wp.func
def anchor_of(scene: Scene, triangle: int) -> wp.vec2i:
    """Place of a triangle's corner 0 [2^-16 px]."""
    table = wp.array(ptr=scene.anchors.ptr, shape=(2 * scene.anchors.shape[0],), dtype=int)
    return wp.vec2i(table[2 * triangle], table[2 * triangle + 1])


@wp.func
def prepared_for(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """What a style worked out about a triangle."""
    triangles = scene.prepared.shape[1]
    first = wp.uint64(64 * triangles) * wp.uint64(parameters.row)
    table = wp.array(ptr=scene.prepared.ptr + first, shape=(16 * triangles,), dtype=float)
    result = Numbers()
    for i in range(16):
        result[i] = table[16 * triangle + i]
    return result


@wp.func
def side_of(scene: Scene, triangle: int, number: int) -> wp.vec2f:
    """Corner 1 (number 0) or 2 (number 1) of a triangle from corner 0 [px of the picture]."""
    return wp.vec2f(scene.sides[triangle, number, 0], scene.sides[triangle, number, 1])


@wp.func
def incentre_of(scene: Scene, triangle: int) -> wp.vec2f:
    """Centre of a triangle's incircle from corner 0 [px of the picture]."""
    return wp.vec2f(scene.incircles[triangle, 0], scene.incircles[triangle, 1])


@wp.func
def depths(lines: wp.mat33f, offset: wp.vec2f) -> wp.vec3f:
    """Distances from the sides of a triangle to the inside, negative outside [px]."""
    return lines * wp.vec3f(offset[0], offset[1], 1.0)


@wp.func
def depth_inside(lines: wp.mat33f, offset: wp.vec2f) -> float:
    """Distance from the nearest side of a triangle to the inside, negative outside [px]."""
    return wp.min(depths(lines, offset))


@wp.func
def full_ink(color: wp.vec3f) -> Ink:
    """Ink that hides what lies below."""
    ink = Ink()
    ink.color = color
    ink.opacity = 1.0
    ink.coverage = 1.0
    return ink


@wp.func
def offset_of(place: wp.vec2i, anchor: wp.vec2i) -> wp.vec2f:
    """A place seen from another one [px]; the difference is exact before it is rounded."""
    away = place - anchor
    return wp.vec2f(float(away[0]), float(away[1])) / FIXED


@wp.func
def sample_at(scene: Scene, triangle: int, place: wp.vec2i) -> Sample:
    """A point of a triangle at a place [2^-16 px]."""
    here = Sample()
    here.triangle = triangle
    here.place = place
    here.offset = offset_of(place, anchor_of(scene, triangle))
    return here


@wp.func
def extent_of(scene: Scene, share: float, samples: int) -> float:
    """Side of what a part of a pixel is: as wide as a strip of so many samples beside a border.

    Args:
        scene: Knows the size of a pixel.
        share: The part, of a pixel.
        samples: Samples of a pixel, across and down each.
    """
    return scene.pixel * wp.max(share, 1.0 / float(samples))
