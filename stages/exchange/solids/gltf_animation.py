"""How runs become meshes of glTF, and when each is seen."""

from fractions import Fraction
from typing import Any

import numpy as np

from stages.exchange.solids.glb import Block
from stages.exchange.solids.runs import MeshRun

VISIBILITY, POINTER = "KHR_node_visibility", "KHR_animation_pointer"
"""Extensions by which a node is shown for a time."""
CELL = 256
"""Points that are blended count from multiples of its inverse [1 / px]; see `mesh_of`."""


def mesh_of(block: Block, run: MeshRun) -> dict[str, Any]:
    """A mesh, with a shape to blend for each pose if there are several.

    A program adds a share of every shape to the mesh, in float32. The mesh lies at multiples of
    1/256 px that are nowhere beyond a pose: what a shape adds is then at most the position itself
    and a multiple of the position's last bit, so it is exact, and so is the sum. Colours are those
    of the first pose, for programs that blend none; they are multiples of 2^-24, so sums of theirs
    are exact as well.

    Args:
        block: Takes the numbers.
        run: The run; each of its triangles has corners of its own.
    """
    poses = run.poses
    points, colors = poses[0].points, poses[0].colors
    if len(poses) > 1:
        lowest = np.min([pose.points for pose in poses], axis=0)
        points = np.floor(lowest * np.float32(CELL)) / np.float32(CELL)
    primitive: dict[str, Any] = {
        "attributes": {
            "POSITION": block.add(points, "vertex places", bounded=True),
            "COLOR_0": block.add(colors, "vertex colors"),
        },
        "material": 0,
    }
    mesh: dict[str, Any] = {"name": run.name, "primitives": [primitive]}
    if len(poses) > 1:
        primitive["targets"] = [
            {
                "POSITION": block.add(pose.points - points, "vertex places", bounded=True),
                "COLOR_0": block.add(pose.colors - colors, "vertex colors"),
            }
            for pose in poses
        ]
        mesh["weights"] = [1, *[0] * (len(poses) - 1)]
    return mesh


def animation_of(block: Block, runs: list[MeshRun], step: Fraction) -> dict[str, Any]:
    """The clip: each run is seen from its first frame to that of the next one.

    Args:
        block: Takes the numbers.
        runs: The runs; node and mesh i are those of run i.
        step: How long the last frame is shown [s].
    """
    start = runs[0].poses[0].time
    begins = [run.poses[0].time - start for run in runs]
    ends = [*begins[1:], runs[-1].poses[-1].time - start + step]
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []

    def _animate(times: int, values: int, interpolation: str, target: dict[str, Any]) -> None:
        channels.append({"sampler": len(samplers), "target": target})
        samplers.append({"input": times, "output": values, "interpolation": interpolation})

    for node, (run, begin, end) in enumerate(zip(runs, begins, ends, strict=True)):
        seen = np.array([0, 1, node == len(runs) - 1], np.uint8)
        marks = np.array([0, begin, end], np.float32)
        if begin == 0:
            seen, marks = seen[1:], marks[1:]
        times = block.add(marks, "times", bounded=True)
        scales = np.repeat(seen[:, None], 3, axis=1).astype(np.float32)
        shown = {"pointer": f"/nodes/{node}/extensions/{VISIBILITY}/visible"}
        hidden = {"path": "pointer", "extensions": {POINTER: shown}}
        _animate(times, block.add(scales, "scales"), "STEP", {"node": node, "path": "scale"})
        _animate(times, block.add(seen, "visibility"), "STEP", hidden)
        if len(run.poses) > 1:
            moments = np.array([pose.time - start for pose in run.poses], np.float32)
            weights = block.add(np.eye(len(moments), dtype=np.float32).ravel(), "weights")
            times = block.add(moments, "times", bounded=True)
            _animate(times, weights, "LINEAR", {"node": node, "path": "weights"})
    return {"name": "clip", "channels": channels, "samplers": samplers}
