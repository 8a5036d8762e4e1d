"""Paper with a grain, of which every triangle is a cut."""

from functools import cache

import numpy as np
import warp as wp

from warp_kernels.scene.scene import (
    Ink,
    Numbers,
    Sample,
    Scene,
    StyleParameters,
    full_ink,
    prepared_for,
)
from warp_kernels.scene.texels import detail_for, texture_at
from warp_kernels.scene.triangle_frame import base_direction, chance
from warp_kernels.styles.shaders.texture import relit

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

SIDE = 512
"""Rows and columns of the tile."""
SLOPE = 1.15
"""Amplitude over wave number to this power: neither a fine dust nor clouds."""
FIBRE = 2.2
"""How much longer the grain is along the base edge than across."""


@cache
def grain() -> np.ndarray:
    """A tile of noise without seams, brightness around 1/2, [rows, columns]."""
    rng = np.random.default_rng(1826)
    down, right = np.fft.fftfreq(SIDE)[:, None] * SIDE, np.fft.fftfreq(SIDE)[None, :] * SIDE
    waves = np.hypot(down, right * FIBRE)
    waves[0, 0] = 1.0
    shape = np.where(waves < 6.0, 0.0, waves**-SLOPE)
    noise = np.fft.ifft2(np.fft.fft2(rng.standard_normal((SIDE, SIDE))) * shape).real
    noise /= noise.std()
    # lit from one side: the slopes of the surface are what is seen of it
    lit = noise - np.roll(noise, 2, axis=(0, 1))
    return np.clip(0.5 + 0.12 * lit / lit.std(), 0.0, 1.0)


@wp.func
def prepare_paper(scene: Scene, parameters: StyleParameters, triangle: int) -> Numbers:
    """Where a triangle lies on the tile, how it is turned there, its brightness and the detail."""
    base = base_direction(scene, triangle) / parameters.numbers[4]
    result = Numbers()
    result[0] = base[0]
    result[1] = base[1]
    result[2] = chance(scene, triangle, 0)
    result[3] = chance(scene, triangle, 1)
    result[4] = 0.5 + parameters.numbers[5] * (chance(scene, triangle, 2) - 0.5)
    result[5] = detail_for(scene, parameters, scene.pixel / parameters.numbers[4])
    return result


@wp.func
def paper_color(scene: Scene, parameters: StyleParameters, sample: Sample, below: wp.vec4f) -> Ink:
    """The paper's colour, relit by the grain; each triangle lies elsewhere in the tile."""
    n = prepared_for(scene, parameters, sample.triangle)
    x = sample.offset[0]
    y = sample.offset[1]
    at = wp.vec2f(n[2] + n[0] * x + n[1] * y, n[3] + n[0] * y - n[1] * x)
    value = texture_at(scene, parameters, 0, at, n[5], True)
    brightness = n[4] + parameters.numbers[3] * (value - 0.5)
    color = wp.vec3f(parameters.numbers[0], parameters.numbers[1], parameters.numbers[2])
    return full_ink(relit(color, wp.clamp(brightness, 0.0, 1.0)))
