"""glTF: what a program sees at the time of a frame is that frame, to the bit of float32."""

import json
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stages.exchange.figure import Figure
from stages.exchange.solids.glb import FLOAT
from stages.exchange.solids.gltf import MOST_POSES
from stages.exchange.solids.linear_light import linear_light
from tests.films import figures_of, film_of, format_with, graded_figures, mixed_figures
from tests.meshes import HEIGHT, two_triangles
from tests.snapshots import snapshot_with

VALIDATOR = """
const fs = require('fs'), validator = require('gltf-validator');
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(report => {
  const told = report.issues.messages.filter(message => message.severity < 2);
  console.log(JSON.stringify(told));
});
"""


class Glb:
    """A reader of no more than is written here, in float32 as a graphics card counts."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        magic, version, size = struct.unpack_from("<4sII", data)
        assert (magic, version, size) == (b"glTF", 2, len(data))
        length = struct.unpack_from("<I", data, 12)[0]
        self.told: dict[str, Any] = json.loads(data[20 : 20 + length])
        self._bytes = data[28 + length :]

    def array(self, number: int) -> np.ndarray:
        one = self.told["accessors"][number]
        view = self.told["bufferViews"][one["bufferView"]]
        kind = np.float32 if one["componentType"] == FLOAT else np.uint8
        width = 3 if one["type"] == "VEC3" else 1
        start = view["byteOffset"] + one["byteOffset"]
        values = np.frombuffer(self._bytes, kind, one["count"] * width, start)
        return values.reshape(-1, 3) if width == 3 else values

    def seen_at(self, time: np.float32, *, knows_visibility: bool) -> list[np.ndarray]:
        """Positions and colours of every node that is seen, one below the other."""
        seen: list[np.ndarray] = []
        for number, node in enumerate(self.told["nodes"]):
            if "mesh" not in node:
                continue
            path = "pointer" if knows_visibility else "scale"
            if np.any(self._value(number, path, time, 1)):
                seen.append(self._mesh(number, node["mesh"], time))
        return seen

    def _mesh(self, node: int, number: int, time: np.float32) -> np.ndarray:
        mesh = self.told["meshes"][number]
        (part,) = mesh["primitives"]
        names = ("POSITION", "COLOR_0")
        sums = [self.array(part["attributes"][name]).copy() for name in names]
        weights = self._value(node, "weights", time, mesh.get("weights", []))
        for weight, target in zip(weights, part.get("targets", []), strict=True):
            for total, name in zip(sums, names, strict=True):
                total += np.float32(weight) * self.array(target[name])
        return np.stack(sums)

    def _value(self, node: int, path: str, time: np.float32, rest: Any) -> Any:
        for animation in self.told.get("animations", []):
            for channel in animation["channels"]:
                target, sampler = channel["target"], animation["samplers"][channel["sampler"]]
                if target["path"] != path or node_of(target) != node:
                    continue
                times = self.array(sampler["input"])
                values = self.array(sampler["output"]).reshape(len(times), -1)
                before = max(0, int(np.searchsorted(times, time, "right")) - 1)
                return values[before]
        return rest


def node_of(target: dict[str, Any]) -> int:
    if "node" in target:
        return int(target["node"])
    return int(target["extensions"]["KHR_animation_pointer"]["pointer"].split("/")[2])


def written(path: Path, figures: list[Figure], style: str = "flat", **options: Any) -> Path:
    format_with(film_of(".glb", style, **options), figures).save(path)
    return path


@pytest.mark.parametrize("knows", [{"knows_visibility": True}, {"knows_visibility": False}])
def test_every_frame_is_seen_alone_and_reads_back_equal(
    tmp_path: Path, knows: dict[str, bool]
) -> None:
    figures = mixed_figures()
    glb = Glb(written(tmp_path / "a.glb", figures))
    assert [len(mesh.get("weights", [])) for mesh in glb.told["meshes"]] == [3, 0, 0, 0]
    for figure in figures:
        (late,) = glb.seen_at(np.float32(figure.time) + np.float32(0.03), **knows)
        (seen,) = glb.seen_at(np.float32(figure.time), **knows)
        assert late.shape == seen.shape  # until the next frame comes the last one is seen
        corners = figure.mesh.corners[:, [0, 2, 1]].reshape(-1, 2)
        wanted = np.stack([corners[:, 0], HEIGHT - corners[:, 1], 0 * corners[:, 0]], axis=1)
        np.testing.assert_array_equal(seen[0], wanted.astype(np.float32))
        np.testing.assert_array_equal(seen[1], np.repeat(linear_light(figure.colors), 3, axis=0))


def test_colours_are_amounts_of_light() -> None:
    light = linear_light(np.arange(256))
    assert (light[0], light[255]) == (0, 1)
    assert light[10] == pytest.approx(10 / 255 / 12.92, abs=1e-7)
    assert light[128] == pytest.approx(0.2158605, abs=1e-7)


def test_gradients_have_the_colours_of_their_corners(tmp_path: Path) -> None:
    figures = graded_figures()
    glb = Glb(written(tmp_path / "a.glb", figures, "gradient"))
    (seen,) = glb.seen_at(np.float32(0.04), knows_visibility=True)
    coefficients = figures[1].snapshot.coefficients
    corners = figures[1].mesh.corners[:, [0, 2, 1]]
    x, y = corners[..., 0], corners[..., 1]
    terms = np.stack([x**a * y**b for a, b in figures[1].snapshot.model.exponents], 2)
    codes = np.clip(np.einsum("tnk,tck->tnc", terms, coefficients), 0, 255)
    np.testing.assert_allclose(seen[1], linear_light(codes).reshape(-1, 3), atol=1e-6)


def test_a_long_rest_is_cut_into_runs(tmp_path: Path) -> None:
    mesh, count = two_triangles(), MOST_POSES + 5
    snapshots = (snapshot_with(mesh, np.full((2, 3), n), n) for n in range(count))
    glb = Glb(written(tmp_path / "a.glb", figures_of(snapshots)))
    assert [len(one.get("weights", [])) for one in glb.told["meshes"]] == [MOST_POSES, 5]
    for number in (MOST_POSES - 1, MOST_POSES):
        (seen,) = glb.seen_at(np.float32(number / 25), knows_visibility=True)
        np.testing.assert_array_equal(
            seen[1], np.repeat(linear_light(np.full((2, 3), number)), 3, 0)
        )


def test_the_validator_finds_nothing(tmp_path: Path) -> None:
    """The Khronos validator (npm `gltf-validator`, where Node finds it)."""
    node = shutil.which("node")
    probe = "require.resolve('gltf-validator')"
    if node is None or subprocess.run([node, "-e", probe], capture_output=True).returncode:
        pytest.skip("no gltf-validator: npm install gltf-validator, and NODE_PATH on its folder")
    still = figures_of([snapshot_with(two_triangles(), np.full((2, 3), 9))])
    cases = [("flat", mixed_figures()), ("gradient", graded_figures()), ("flat", still)]
    for number, (style, figures) in enumerate(cases):
        path = written(tmp_path / f"{number}.glb", figures, style)
        command = [node, "-e", VALIDATOR, str(path)]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert json.loads(said) == []
