"""A picture in every triangle, which makes it brighter and darker."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import warp as wp

from warp_kernels.errors import OptionError, TrimotionError
from warp_kernels.scene import (
    Ink,
    Numbers,
    Sample,
    Scene,
    StyleParameters,
    color_of,
    full_ink,
    prepared_for,
    side_of,
)
from warp_kernels.styles.pictures import PICTURES
from warp_kernels.styles.style import ReadPicture, Style
from warp_kernels.texture import Texture as Texels
from warp_kernels.texture import detail_for, texture_at

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@wp.func
def ground_below(scene: Scene, sample: Sample, below: wp.vec4f) -> wp.vec3f:
    """What lies below, and the triangle's mean colour where that is transparent."""
    color = color_of(scene, sample.triangle)
    return color + below[3] * (wp.vec3f(below[0], below[1], below[2]) - color)


@wp.func
def relit(color: wp.vec3f, brightness: float) -> wp.vec3f:
    """A colour made black by brightness 0, white by 1 and left alone by 1/2."""
    dark = wp.min(2.0 * brightness, 1.0) * color
    light = wp.max(2.0 * brightness - 1.0, 0.0)
    return dark + light * (wp.vec3f(255.0, 255.0, 255.0) - dark)


@wp.func
def prepare_texture(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Change of the position in the picture per px, to the left and upwards, and the detail."""
    first = side_of(scene, triangle, 0)
    second = side_of(scene, triangle, 1)
    area = wp.max(wp.abs(first[0] * second[1] - first[1] * second[0]), 1.0e-6)
    up = wp.vec2f(-first[1], first[0]) / area
    left = wp.vec2f(second[1], -second[0]) / area + 0.5 * up
    result = Numbers()
    for i in range(2):
        result[i] = left[i]
        result[2 + i] = up[i]
    steep = wp.max(wp.length(left), wp.length(up))
    result[4] = detail_for(scene, parameters, steep * scene.pixel)
    return result


@wp.func
def textured_color(
    scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f
) -> Ink:
    """What lies below, relit by the texture; the picture's lower edge is the base edge."""
    n = prepared_for(scene, parameters, sample.triangle)
    left = n[0] * sample.offset[0] + n[1] * sample.offset[1]
    up = n[2] * sample.offset[0] + n[3] * sample.offset[1]
    value = texture_at(scene, parameters, 0, wp.vec2f(1.0 - left, 1.0 - up), n[4], False)
    brightness = 0.5 + parameters.numbers[0] * (value - 0.5)
    return full_ink(relit(ground_below(scene, sample, below), wp.clamp(brightness, 0.0, 1.0)))


@dataclass(frozen=True)
class Texture(Style):
    """A texture that modulates brightness: of what lies below, or of the triangle's colour.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6.
    Deviation: a middle grey leaves colours alone and a lighter one brightens them.
    """

    file: str = field(
        default="cushion",
        metadata={"help": "cushion, triangle, or a picture whose lower edge is the base edge"},
    )
    strength: float = field(
        default=1.0, metadata={"help": "contrast of the picture", "range": (0.0, 4.0)}
    )

    shader: ClassVar[Any] = textured_color
    prepare: ClassVar[Any] = prepare_texture
    portraits: ClassVar[tuple[str, ...]] = ("texture:cushion", "texture:triangle")

    def numbers(self) -> tuple[float, ...]:
        """Strength."""
        return (self.strength,)

    def texture(self, read: ReadPicture) -> Texels | None:
        """The picture that was asked for."""
        if self.file in PICTURES:
            return Texels.of(PICTURES[self.file]()[None])
        try:
            return Texels.of(read(self.file)[None])
        except TrimotionError as error:
            known = ", ".join(PICTURES)
            raise OptionError(f"texture:{self.file}: {error}; or choose from {known}") from error
