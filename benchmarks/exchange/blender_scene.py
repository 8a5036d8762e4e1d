"""Inside Blender: import a file and render frames of it as it stands.

    blender -b --factory-startup --python blender_scene.py -- FILE OUT_####.png SHIFT WxH FRAME ...
    python blender_scene.py FILE OUT_####.png SHIFT WxH FRAME ...       (with PyPI bpy)

SHIFT is added to each frame of the source to find that of Blender. Says what was imported.
"""

import sys
from pathlib import Path

import bpy


def main(file: str, pattern: str, shift: int, size: tuple[int, int], frames: list[int]) -> None:
    """Import, then render."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    if file.endswith(".glb"):
        bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
        scene.render.fps = 25
        bpy.ops.import_scene.gltf(filepath=file)
    else:
        bpy.ops.wm.usd_import(filepath=file)
    cameras = [one for one in bpy.data.objects if one.type == "CAMERA"]
    meshes = [one for one in bpy.data.objects if one.type == "MESH"]
    counts = f"{len(meshes)} meshes, {len(cameras)} cameras"
    print(f"imported {counts}, Blender {bpy.app.version_string}")
    scene.camera = cameras[0]
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 4
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0
    scene.cycles.max_bounces = 0
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.dither_intensity = 0
    scene.render.image_settings.file_format = "PNG"
    for frame in frames:
        scene.frame_set(shift + frame)
        scene.render.filepath = str(Path(pattern.replace("####", f"{frame:04}")))
        bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    file, pattern, shift, size, *frames = given
    width, height = map(int, size.split("x"))
    main(file, pattern, int(shift), (width, height), list(map(int, frames)))
