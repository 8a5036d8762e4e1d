"""As many triangles as were asked for, not one more or less."""

import json
from pathlib import Path

import media_samples as samples
import numpy as np
import pytest

from pipeline.cli import main
from stages.topology.appraise import Appraiser
from stages.topology.exact_count import with_exactly
from stages.topology.goal import SLIVER_HEIGHT
from stages.validate import assert_valid
from tests.kernel_samples import waves
from tests.meshes import random_mesh
from warp_kernels.color_model import CONSTANT
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Waves that move."""
    frames = [np.roll(waves(96, 64), 2 * k, axis=1) for k in range(5)]
    return samples.write_video(tmp_path / "in.mp4", frames)


@pytest.mark.parametrize(
    "options",
    [
        "--triangles 60",
        "--triangles 61 --layout grid",
        "--triangles 75 --topology delaunay",
        "--triangles 44 --focus center --color linear",
        "--triangles 47 --independent",
        "--triangles 90 --max-area 400",
        "--triangles 33 --iterations 0",
    ],
)
def test_every_frame_has_the_wanted_count(clip: Path, options: str, tmp_path: Path, capsys) -> None:
    """In first frames and later ones, whatever makes and changes the mesh."""
    command = ["solve", str(clip), "-o", str(tmp_path / "a.mtrk"), "--progress", "json"]
    assert main([*command, "--iterations", "24", *options.split()]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    counts = [event["triangles"] for event in events if event["event"] == "frame"]
    assert counts == [int(options.split()[1])] * 5


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("more", [-9, -2, -1, 0, 1, 2, 7])
def test_any_mesh_comes_to_the_count(seed: int, more: int) -> None:
    """By valid edits; nothing is touched where nothing is missing."""
    mesh = random_mesh(seed, 40)
    with Device("cpu") as device:
        workspace = Workspace(device, (mesh.width, mesh.height), CONSTANT)
        workspace.load_image(waves(mesh.width, mesh.height))
        appraiser = Appraiser(workspace, SLIVER_HEIGHT)
        found = with_exactly(mesh.triangle_count + more, mesh, appraiser)
    assert found.triangle_count == mesh.triangle_count + more
    assert_valid(found)
    assert (found is mesh) == (more == 0)
