"""Inside Blender: a relief seen from the side, as docs/images/relief.jpg has it.

    python relief_in_blender.py FILE OUT.png WxH RIGHT UP      (with PyPI bpy)

RIGHT and UP [degrees] are from where one looks.
"""

import math
import sys

import bpy
from mathutils import Vector

AWAY = 1.65
"""Distance of the camera, in diagonals of all that there is."""
DARK = (0.02, 0.02, 0.025, 1.0)
"""Light of what lies around."""


def main(file: str, target: str, size: tuple[int, int], right: float, up: float) -> None:
    """Import, look, render."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    read = bpy.ops.import_scene.gltf if file.endswith(".glb") else bpy.ops.wm.usd_import
    read(filepath=file)
    look_from(right, up)
    scene.world = bpy.data.worlds.new("around")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = DARK
    scene.render.engine, scene.cycles.samples = "CYCLES", 32
    scene.cycles.device, scene.cycles.use_denoising = "CPU", False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.filepath = target
    bpy.ops.render.render(write_still=True)


def look_from(right: float, up: float) -> None:
    """A camera at these angles that has everything in sight; pictures stand upright, face to -y."""
    meshes = [one for one in bpy.data.objects if one.type == "MESH"]
    corners = [one.matrix_world @ Vector(corner) for one in meshes for corner in one.bound_box]
    low = Vector(map(min, zip(*corners, strict=True)))
    high = Vector(map(max, zip(*corners, strict=True)))
    a, b = math.radians(right), math.radians(up)
    towards = Vector((math.sin(a) * math.cos(b), -math.cos(a) * math.cos(b), math.sin(b)))
    camera = bpy.data.objects.new("side", bpy.data.cameras.new("side"))
    camera.data.lens, camera.data.clip_start, camera.data.clip_end = 60, 0.001, 100
    camera.location = (low + high) / 2 + towards * (high - low).length * AWAY
    camera.rotation_euler = (-towards).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


if __name__ == "__main__":
    file, target, size, right, up = sys.argv[1:]
    width, height = map(int, size.split("x"))
    main(file, target, (width, height), float(right), float(up))
