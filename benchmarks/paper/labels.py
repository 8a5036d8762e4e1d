"""Which triangle covers a pixel, by the program's own rule."""

import numpy as np
import warp as wp

from stages.mesh import Mesh
from warp_kernels.device.device import Device
from warp_kernels.drawing.band_lists import BandLists
from warp_kernels.drawing.gbuffer import fill_threads, record_gbuffer


def triangle_of_pixels(device: Device, mesh: Mesh) -> np.ndarray:
    """The triangle of every pixel of the picture that a mesh covers, [H, W] int32.

    Args:
        device: Where to run.
        mesh: The mesh.
    """
    vertices = device.empty(mesh.vertex_count, wp.vec2d)
    triangles = device.empty(mesh.triangle_count, wp.vec3i)
    lists = BandLists(device, mesh.height, mesh.height)
    labels = device.empty((mesh.height, mesh.width), wp.int32)
    device.write(vertices, mesh.vertices)
    device.write(triangles, mesh.triangles)
    lists.write(mesh.vertices, mesh.triangles, 1.0)
    phase = record_gbuffer(
        device,
        vertices=vertices,
        triangles=triangles,
        lists=lists,
        band=0,
        scale=(1.0, 1.0),
        first_row=0,
        samples=1,
        triangle_out=labels,
    )
    phase.resize(mesh.height, threads=fill_threads(device, mesh.triangle_count))
    device.run([phase])
    return device.read(labels, mesh.height)
