"""What a shader needs to know of a triangle, worked out once for all of its pixels."""

from functools import cache
from typing import Any

import warp as wp

from warp_kernels.device.device import Device
from warp_kernels.device.exact import EXACT
from warp_kernels.device.phase import Phase
from warp_kernels.scene.scene import Numbers, Scene, StyleParameters

wp.set_module_options({"enable_backward": False, "fuse_fp": False})


@cache
def prepare_kernel(prepare: Any) -> Any:
    """The kernel that looks at a triangle on behalf of a style."""

    @wp.kernel(module="unique", module_options=EXACT)
    def prepare_triangles(
        span: wp.array(dtype=wp.vec2i),
        # In:
        scene: Scene,
        parameters: wp.array(dtype=StyleParameters),
        style: int,
        # Out:
        prepared_out: wp.array2d(dtype=Numbers),
    ):
        """Prepare one triangle for a style."""
        triangle = span[0][0] + wp.tid()
        if triangle < span[0][1]:
            prepared_out[style, triangle] = prepare(scene, parameters[style], triangle)

    return prepare_triangles


def record_prepare(
    device: Device,
    *,
    prepare: Any,
    style: int,
    scene: Any,
    parameters: wp.array,
    prepared_out: wp.array,
) -> Phase:
    """Prepare the launch that looks at every triangle on behalf of a style.

    Args:
        device: Where to run.
        prepare: A wp.func `(Scene, StyleParameters, triangle) -> Numbers`.
        style: The style's number in the stack.
        scene: What shaders look at, a `Scene`.
        parameters: One `StyleParameters` per style.
        prepared_out: `Scene.prepared`, [styles, triangles] Numbers.
    """
    inputs = [scene, parameters, style]
    return device.record(prepare_kernel(prepare), inputs, [prepared_out])
