"""The emulated card and the CPU agree to the bit; run by `make cuda-check`, not with the suite."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pipeline.loop.animate import animate
from pipeline.progress import Progress
from stages.media import open_decoder
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from tests import media_samples as samples
from tests.jobs import job_of
from tests.kernel_samples import noise, poisoned_workspace, random_mesh, random_weights
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.energy.sums import SUMS
from warp_kernels.energy.topology_survey import Survey
from warp_kernels.energy.workspace import Workspace
from warp_kernels.styles import STYLES

SIZE = (61, 47)
"""Of the pictures [px]."""
FRAMES = 10
INEXACT: dict[str, int] = {}
"""Styles that may differ, by how many code values; none does here, where both libraries are one."""


def on(device: str, model: str, sums: str, *, weighted: bool) -> Workspace:
    """A mesh over noise."""
    weights = random_weights(*SIZE) if weighted else None
    mesh = random_mesh(*SIZE, 60)
    kind = COLOR_MODELS[model]
    return poisoned_workspace(Device(device, 1), noise(*SIZE), mesh, kind, sums, weights)


def solved(workspace: Workspace) -> list[np.ndarray]:
    """Everything that fifty iterations lead to."""
    workspace.hold(np.zeros((len(workspace.vertices()), 3)))
    workspace.iterate(50, trust=0.5, regularity=1e-3)
    return [workspace.vertices(), workspace.energies(), *workspace.moments(), *workspace.fit()]


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("sums", SUMS)
@pytest.mark.parametrize("model", COLOR_MODELS)
def test_iterations(model: str, sums: str, weighted: bool, device: str) -> None:
    """Fifty, and what is measured after them."""
    results = [solved(on(name, model, sums, weighted=weighted)) for name in ("cpu", device)]
    for expected, actual in zip(*results, strict=True):
        np.testing.assert_array_equal(actual, expected)


def gains(workspace: Workspace) -> list[Any]:
    """What flips, collapses and splits of every edge of a mesh would gain."""
    mesh = random_mesh(*SIZE, 60)
    survey = Survey(workspace)
    survey.load_topology(mesh.twins.ravel(), mesh.triangles.ravel())
    chosen = np.flatnonzero(mesh.twins.ravel() >= 0)
    measured = survey.flip_gains(chosen), survey.collapse_costs(chosen), survey.split_gains(chosen)
    return [measured[0], measured[1], *measured[2]]


@pytest.mark.parametrize("model", COLOR_MODELS)
def test_gains(model: str, device: str) -> None:
    """Of all edges within."""
    results = [gains(on(name, model, "edges", weighted=False)) for name in ("cpu", device)]
    for expected, actual in zip(*results, strict=True):
        np.testing.assert_array_equal(actual, expected)


def film(folder: Path, device: str, **look: Any) -> np.ndarray:
    """Ten restless frames of 64 x 48, converted, [F, H, W, 3] uint8."""
    pictures = [samples.picture(64, 48, 2 * number) for number in range(FRAMES)]
    clip = samples.write_video(folder / "clip.mp4", pictures)
    quick = TriangulateOptions(
        iterations=40, frame_iterations=6, refine=RefineOptions(triangles=120)
    )
    output = folder / f"{device}.mkv"
    job = job_of(clip, output, triangulate=quick, codec="ffv1", device=device, **look)
    animate(job, Progress())
    with open_decoder(output) as decoder:
        return np.stack([frame.pixels for frame in decoder])


@pytest.mark.parametrize("style", STYLES)
def test_clips(style: str, device: str, tmp_path: Path) -> None:
    """Solved and drawn, with triangles that fade in."""
    look = {"styles": (STYLES["paper"](), STYLES[style](opacity=0.75)), "fade": 4}
    expected, actual = (film(tmp_path, name, **look) for name in ("cpu", device))
    off = np.abs(actual.astype(int) - expected).max()
    assert off <= INEXACT.get(style, 0)
