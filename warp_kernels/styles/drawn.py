"""Triangles that are drawn with strokes along their base edges: what all such styles share."""

from dataclasses import dataclass, field
from functools import cache
from math import cos, radians, sin
from typing import Any, ClassVar

import warp as wp

from warp_kernels.blend import to_code, to_light
from warp_kernels.scene import Ink, Numbers, Sample, Scene, StyleParameters, full_ink
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import ReadPicture, Style
from warp_kernels.texture import LINE, Texture
from warp_kernels.tones.lookup import ink_at, level_for, packed_tones, pair_of
from warp_kernels.tones.tonal_art_map import DARKEST, SPACING, Drawing, tonal_art_map

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

NO_PAPER = "none"
"""Written instead of a colour where what lies below is the paper."""
SHARPNESS = 0.7
"""Part of a pixel that a level of detail may blur: at 1 lines lose too much contrast."""
TINT = 0.5
"""How much of a triangle's colour lies under the strokes of coloured pencils."""
SATURATION = 0.3
"""How much more ink than the least a coloured pencil leaves: less is brighter, more is duller."""


@wp.func
def base_edge(scene: Scene, triangle: int) -> wp.vec2f:
    """Unit vector along the edge that strokes follow, chosen by chance but for ever.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5: randomly chosen; Sec.
        3.5: users turn it, which turns the row of corners here.
    """
    edge = scene.sides[triangle, 0]
    choice = (scene.hashes[triangle] >> wp.uint32(24)) % wp.uint32(3)
    if choice == wp.uint32(1):
        edge = scene.sides[triangle, 1] - scene.sides[triangle, 0]
    if choice == wp.uint32(2):
        edge = -scene.sides[triangle, 1]
    return edge / wp.max(wp.length(edge), 1.0e-6)


@wp.func
def place_of_tile(scene: Scene, triangle: int, seed: wp.uint32) -> wp.vec2f:
    """Where the triangle's centre lies on the tile: anywhere, but for ever.

    In parts of the tile's sides. Else triangles smaller than a tile would show the same strokes.
    """
    number = (scene.hashes[triangle] ^ seed) * wp.uint32(747796405)
    right = float(int(number >> wp.uint32(23)))
    down = float(int((number >> wp.uint32(14)) & wp.uint32(511)))
    return wp.vec2f(right, down) / 512.0


@wp.func
def pencil_ink(light: wp.vec3f, paper: wp.vec3f) -> float:
    """Part of the paper that a pencil of a triangle's colour covers, at least what it needs."""
    left = wp.min(
        wp.min(light[0] / paper[0], light[1] / paper[1]), wp.min(light[2] / paper[2], 1.0)
    )
    return 1.0 - left * (1.0 - SATURATION)


@wp.func
def prepare_strokes(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Light of the pen, pair of tones and share, level, turn to the tile, place on it.

    The place is seen from the triangle's centre: what is farthest from it moves most when the
    base edge turns a little.
    """
    n = parameters.numbers
    color = scene.colors[triangle] / 255.0
    dark = 1.0 - (0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])
    amount = dark * (1.0 - n[9] + n[9] * dark)
    pen = wp.vec3f(n[0], n[1], n[2])
    paper = wp.vec3f(n[3], n[4], n[5])
    if n[10] > 0.0:
        light = to_light(scene.colors[triangle])
        tinted = wp.lerp(paper, light, n[10] * TINT)
        covered = wp.min(pencil_ink(light, tinted), DARKEST)
        pencil = wp.max(tinted - (tinted - light) / wp.max(covered, 0.02), wp.vec3f())
        pen = wp.lerp(pen, pencil, n[10])
        paper = tinted
        amount = wp.lerp(amount, covered, n[10])
    tones = pair_of(amount)
    level = level_for(n[6] * scene.pixel * SHARPNESS, parameters.level_count)
    table = scene.levels[parameters.first_level + level]
    side = table[2]
    edge = base_edge(scene, triangle)
    texels = n[6] * 256.0 / float(1 << level)
    turn = wp.vec2f(
        texels * (edge[0] * n[7] - edge[1] * n[8]), texels * (edge[0] * n[8] + edge[1] * n[7])
    )
    centre = (scene.sides[triangle, 0] + scene.sides[triangle, 1]) / 3.0
    place = 256.0 * float(side) * place_of_tile(scene, triangle, wp.uint32(n[11]))
    result = Numbers()
    for i in range(3):
        result[i] = pen[i]
        result[10 + i] = paper[i]
    result[3] = float(table[0] / LINE + int(tones[0]) * (2 * side * side / LINE))
    result[4] = tones[1]
    result[5] = float(side)
    result[6] = turn[0]
    result[7] = turn[1]
    result[8] = place[0] - centre[0] * turn[0] - centre[1] * turn[1] - 128.0
    result[9] = place[1] + centre[0] * turn[1] - centre[1] * turn[0] - 128.0
    return result


@wp.func
def ink_of(scene: Scene, n: Numbers, offset: wp.vec2f) -> float:
    """Part of the paper that is inked at a point of a triangle; see `prepare_strokes`."""
    x = int(n[8] + offset[0] * n[6] + offset[1] * n[7])
    y = int(n[9] - offset[0] * n[7] + offset[1] * n[6])
    return ink_at(scene, int(n[3]), int(n[5]), n[4], x, y)


@wp.func
def strokes_on_paper(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """Strokes and the paper that they are drawn on."""
    n = scene.prepared[parameters.row, sample.triangle]
    pen = wp.vec3f(n[0], n[1], n[2])
    paper = wp.vec3f(n[10], n[11], n[12])
    return full_ink(to_code(paper + ink_of(scene, n, sample.offset) * (pen - paper)))


@wp.func
def strokes(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """Strokes on what lies below."""
    n = scene.prepared[parameters.row, sample.triangle]
    ink = Ink()
    ink.color = to_code(wp.vec3f(n[0], n[1], n[2]))
    ink.opacity = 1.0
    ink.coverage = ink_of(scene, n, sample.offset)
    return ink


@dataclass(frozen=True)
class Drawn(Style):
    """Strokes of a pen or a pencil, denser where the picture is darker.

    They lie in the plane of the picture, so all of them have one width, and they are fixed to the
    centre and the base edge of their triangle: they move with it and in no other way.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5; Praun et al., Real-time
        hatching (2001), Sec. 5: blending between tones.
    Deviation: distances from the base edge are those in the picture, where the paper scales
        barycentric coordinates by its length: strokes of flat triangles keep their width too.
    """

    spacing: float = field(
        default=4.0,
        metadata={
            "help": "distance of neighbouring lines",
            "unit": "px of the source",
            "range": (1.0, 100.0),
        },
    )
    weight: float = field(
        default=0.26,
        metadata={
            "help": "width of the thinnest lines",
            "unit": "of the spacing",
            "range": (0.05, 0.6),
        },
    )
    angle: float = field(
        default=0.0,
        metadata={
            "help": "turn of the lines from the base edge",
            "unit": "degrees",
            "range": (-180.0, 180.0),
        },
    )
    ink: str = field(default="#24242c", metadata={"help": "#rgb or #rrggbb", "form": "color"})
    paper: str = field(
        default="#f8f4ea",
        metadata={"help": "#rgb or #rrggbb, or none: strokes alone, on what lies below"},
    )
    colored: float = field(
        default=0.0,
        metadata={
            "help": "ink (0) or pencils in the colours of the triangles (1)",
            "range": (0, 1),
        },
    )
    lighten: float = field(
        default=0.5,
        metadata={"help": "how much lighter than the picture ink is laid", "range": (0.0, 1.0)},
    )
    grain: float = field(
        default=0.0,
        metadata={"help": "roughness of the paper: pen (0) to soft pencil (1)", "range": (0, 1)},
    )
    seed: int = field(
        default=0, metadata={"help": "chooses one of many drawings", "range": (0, 65535)}
    )

    prepare: ClassVar[Any] = prepare_strokes
    drawing: ClassVar[Drawing]
    """The strokes."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.paper != NO_PAPER:
            parse_color(self.paper)

    @property
    def shader(self) -> Any:
        """One of two, by whether there is paper."""
        return strokes if self.paper == NO_PAPER else strokes_on_paper

    @property
    def is_opaque(self) -> bool:
        """Whether there is paper."""
        return self.paper != NO_PAPER and super().is_opaque

    def numbers(self) -> tuple[float, ...]:
        """Light of ink and of paper, texels per px, turn, lighten, colored, seed, with paper."""
        sheet = "#fff" if self.paper == NO_PAPER else self.paper
        light = (value**2 for text in (self.ink, sheet) for value in parse_color(text))
        turn = radians(self.angle)
        has_paper = float(self.paper != NO_PAPER)
        return (
            *light,
            SPACING / self.spacing,
            cos(turn),
            sin(turn),
            self.lighten,
            self.colored,
            float(self.seed),
            has_paper,
        )

    def texture(self, read: ReadPicture) -> Texture:
        """The tonal art map."""
        return _texture_of(type(self).drawing, self.weight, self.grain, self.seed)


@cache
def _texture_of(drawing: Drawing, weight: float, grain: float, seed: int) -> Texture:
    return packed_tones(tonal_art_map(drawing, width=weight, grain=grain, seed=seed))
