"""Every kernel that a job can launch is compiled without fused multiplication and addition."""

import re
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import warp as wp

from stages.render import Renderer
from stages.snapshot import Snapshot
from tests.kernel_samples import random_mesh
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, LINEAR
from warp_kernels.device.device import Device, Phase
from warp_kernels.drawing.layers import Layers
from warp_kernels.drawing.paint import Paint
from warp_kernels.energy.nearby_colors import Nearby
from warp_kernels.energy.sums import SUMS
from warp_kernels.energy.topology_survey import Survey
from warp_kernels.energy.workspace import Workspace
from warp_kernels.styles import STYLES

SIZE = (64, 48)
ARITHMETIC = re.compile(r"\b(?:add|sub|mul|fma|mad|div|sqrt|rcp|rsqrt|ex2|lg2)\.[\w.]*f(?:32|64)\b")
"""Instructions of a compiled kernel that compute in floating point."""
ROUNDED = re.compile(r"(?:mul|div|sqrt|rcp)\.rn\.f(?:32|64)|(?:add|sub)(?:\.rn)?\.f(?:32|64)")
"""Those that round as the standard says, each on its own: a product that says how it is rounded is
not fused with a sum, whether this says so or not."""


class Nothing(Phase):
    """A phase without a launch."""

    def __init__(self) -> None:
        super().__init__([], lambda number, begin, end: None, 1, 1)

    def resize(self, count: int, **_: Any) -> None:
        """Nothing becomes no larger."""


class NotingDevice(Device):
    """Notes what would be launched, and compiles and launches nothing."""

    def __init__(self) -> None:
        super().__init__("cpu", 1)
        self.kernels: dict[Any, None] = {}

    def record(self, kernel: Any, inputs: Sequence[Any], outputs: Sequence[Any], **_: Any) -> Phase:
        """Note the kernel."""
        self.kernels[kernel] = None
        return Nothing()

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Do nothing."""


def note_solver(device: Device) -> None:
    """Ask for every kernel that solving can need; all changes of topology for one colour model."""
    for model, sums in product(COLOR_MODELS.values(), SUMS):
        Workspace(device, SIZE, model, sums, weighted=model is LINEAR)
    survey = Survey(Workspace(device, SIZE, CONSTANT))
    survey.load_topology(np.zeros(3, int), np.zeros(3, int))
    for measured in (survey.flip_gains, survey.collapse_costs, survey.split_gains):
        measured(np.zeros(1, int))
    for model in COLOR_MODELS.values():
        nothing = np.zeros((1, 3, model.term_count)), np.zeros(1), np.zeros((1, 2, 3), np.uint8)
        Nearby(Workspace(device, SIZE, model)).measure(*nothing)


def note_drawing(device: Device) -> None:
    """Ask for the kernels of every style, alone and where triangles fade."""
    mesh = random_mesh(*SIZE, 12)
    T = mesh.triangle_count
    layers = Layers(
        np.ones(T, np.float32),
        np.zeros((T, 2, 2), np.float32),
        np.zeros((T, 2)),
        np.zeros((T, 2), np.int32),
        np.zeros(1, np.int32),
    )
    snapshot = Snapshot(
        0, 0, 1, mesh, LINEAR, np.zeros((T, 3, 3)), np.zeros(T), np.ones(T, np.int64)
    )
    picture = np.zeros((*SIZE[::-1], 3), np.uint8)
    for style in STYLES.values():
        renderer = Renderer(device, SIZE, SIZE, (style(),))
        renderer.render(snapshot, source=picture)
        renderer.render(snapshot, _Faded(layers), source=picture)


class _Faded:
    """What lingers, with layers that are given."""

    def __init__(self, layers: Layers) -> None:
        self._layers = layers

    def layers(self) -> tuple[Paint, Layers]:
        """The paint does not matter."""
        count = len(self._layers.weights)
        corners = np.zeros((count, 3, 2))
        limits = np.broadcast_to([[[0.0], [255.0]]], (count, 2, 3))
        colors, slopes = np.zeros((count, 3)), np.zeros((count, 2, 3))
        paint = Paint(colors, slopes, None, limits, corners, np.arange(count))
        return paint, self._layers


@pytest.fixture(scope="module")
def kernels() -> list[Any]:
    """Every kernel that is launched by solving and by drawing."""
    device = NotingDevice()
    note_solver(device)
    note_drawing(device)
    return list(device.kernels)


def test_no_kernel_fuses(kernels: list[Any]) -> None:
    """By the options that its module really has, as Warp resolves them."""
    names = {kernel.key.split("__")[-1] for kernel in kernels}
    for name in ("sum_row", "sum_along_edges", "solve_variants", "fit_colors", "descend"):
        assert any(name in known for known in names), (name, names)
    assert len(kernels) > 40
    fused = [k.key for k in kernels if k.module.resolve_options(wp.config)["fuse_fp"]]
    assert not fused


@pytest.mark.parametrize("name", ["solve_variants", "fit_colors", "descend"])
def test_compiled_kernels_round_as_the_cpu(name: str, kernels: list[Any], tmp_path: Path) -> None:
    """As Warp compiles them for CUDA, which needs no card: three that decide about meshes."""
    if not wp.get_cuda_supported_archs():
        pytest.skip("this Warp has no compiler for CUDA")
    kernel = next(k for k in kernels if k.key.split("__")[-1].startswith(name))
    (path,) = wp.compile_aot_module(kernel.module, arch=75, module_dir=tmp_path, use_ptx=True)
    found = set(ARITHMETIC.findall(Path(path).read_text(encoding="utf-8")))
    assert found
    assert all(map(ROUNDED.fullmatch, found)), found
