"""glTF 2.0: one binary file for browsers, games and 3D programs, with the clip as an animation."""

from fractions import Fraction
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.size_limit import refuse_size
from stages.exchange.solids.corners import HELD, corners_of, refuse_stacks
from stages.exchange.solids.glb import MOST_BYTES, Block
from stages.exchange.solids.gltf_animation import POINTER, VISIBILITY, animation_of, mesh_of
from stages.exchange.solids.linear_light import linear_light
from stages.exchange.solids.runs import MeshPose, MeshRuns
from stages.exchange.solids.viewpoint import METRES, Viewpoint

MOST_POSES = 64
"""Poses of a run. Graphics cards take at least 256 shapes to blend between, and which of n poses is
seen takes n^2 numbers."""
UNLIT = "KHR_materials_unlit"
"""Extension by which colours are shown as they are, whatever lights there are."""
MATERIAL = {
    "name": "colors",
    "doubleSided": True,
    "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {UNLIT: {}},
}
"""What all triangles are made of; their colours are those of their vertices."""


class Gltf(Format):
    """A node for every run of unchanged topology, shown in its time; poses of a run are blended.

    Whether a node is seen is said twice: by its visibility, and by a scale of 0 for programs that
    do not know that extension.

    Source: Khronos, glTF 2.0 Specification; the extensions KHR_node_visibility,
    KHR_animation_pointer and KHR_materials_unlit.
    """

    styles: ClassVar[tuple[str, ...]] = HELD
    most_degree: ClassVar[int] = 1

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._runs = MeshRuns(MOST_POSES)

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format, and one style only."""
        super().check(film)
        refuse_stacks(film)

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        count = figure.mesh.triangle_count
        refuse_size(self.film, count, 6 * 12 * count, MOST_BYTES)
        corners = corners_of(figure, self.film)
        codes = np.rint(corners.colors) if self.film.styles[-1].degree == 0 else corners.colors
        points, light = corners.points.reshape(-1, 3), linear_light(codes).reshape(-1, 3)
        rows = np.arange(3 * count).reshape(-1, 3)
        self._runs.add(figure, rows, MeshPose(figure.index, figure.time, points, light))

    def save(self, path: Path) -> None:
        """Write them."""
        block, runs = Block(), self._runs.found
        meshes = [mesh_of(block, run) for run in runs]
        nodes: list[dict[str, Any]] = [
            {"name": run.name, "mesh": number} for number, run in enumerate(runs)
        ]
        scene: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "trimotion"},
            "extensionsUsed": [UNLIT],
            "scene": 0,
            "scenes": [{"nodes": [len(nodes), len(nodes) + 1]}],
            "nodes": [*nodes, self._root(len(nodes)), self._viewer()],
            "cameras": [self._camera()],
            "meshes": meshes,
            "materials": [MATERIAL],
        }
        if len(runs) > 1 or len(runs[0].poses) > 1:
            for number, node in enumerate(nodes):
                node["extensions"] = {VISIBILITY: {"visible": True}}
                if number:  # programs without animation show the first frame alone
                    node["scale"] = [0, 0, 0]
            rate = self.film.rate or Fraction(25)
            scene["animations"] = [animation_of(block, runs, 1 / rate)]
            scene["extensionsUsed"] = [UNLIT, VISIBILITY, POINTER]
        block.save(path, scene)

    def _root(self, count: int) -> dict[str, Any]:
        """The node above all runs: in metres, the picture's centre in the middle of the world."""
        width, height = self.film.size
        return {
            "name": self.film.name,
            "scale": [METRES] * 3,
            "translation": [-METRES * width / 2, -METRES * height / 2, 0],
            "children": list(range(count)),
        }

    def _viewer(self) -> dict[str, Any]:
        distance = METRES * Viewpoint.of(self.film).distance
        return {"name": "camera", "camera": 0, "translation": [0, 0, distance]}

    def _camera(self) -> dict[str, Any]:
        """A camera whose picture is the picture."""
        width, height = self.film.size
        view = Viewpoint.of(self.film)
        return {
            "type": "orthographic",
            "orthographic": {
                "xmag": METRES * width / 2,
                "ymag": METRES * height / 2,
                "znear": METRES * view.near,
                "zfar": METRES * view.far,
            },
        }
