"""What a style's shader may look at."""

import warp as wp

StyleParameters = wp.types.vector(length=8, dtype=wp.float32)
"""A style's numbers, in the order that the style itself fixes; the rest is zero."""


@wp.struct
class Scene:
    """One frame's triangles, as shaders see them."""

    colors: wp.array(dtype=wp.vec3f)
    """Mean colour of every triangle [code values], [T]."""
    gradients: wp.array2d(dtype=wp.vec3f)
    """Change of colour per px to the right and down, at the centre [code values / px], [T, 2]."""
    curvatures: wp.array2d(dtype=wp.vec3f)
    """What a quadratic colour adds to that: its difference from the mean at the centre [code
    values], then the coefficients of x^2, x y and y^2 from there [code values / px^2], [T, 4]."""
    curved: wp.array(dtype=int)
    """1 where colours are quadratic, 0 where `curvatures` are not to be read, [1]."""
    centres: wp.array(dtype=wp.vec2f)
    """Centroid of every triangle, where a linear colour has its mean [px of the picture], [T]."""
    edge_coverage: wp.array2d(dtype=float)
    """Part of every output pixel covered by drawn edges, [rows, columns]; may be empty."""


@wp.struct
class Sample:
    """The point that is shaded."""

    triangle: int
    """Number of the triangle under it."""
    position: wp.vec2f
    """Position in the source picture [px]."""
    row: int
    """Row of the output pixel."""
    column: int
    """Column of the output pixel."""
