"""What the benchmarks share: a picture, timed repetitions, the machine's name, tables."""

import argparse
import platform
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

import cv2
import numpy as np

from stages.layouts.importance import Importance
from stages.mesh import Mesh
from stages.optimize import load_mesh
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace

DEFAULT_PICTURE = Path(__file__).parents[1] / "sample_videos" / "astronaut.jpg"
TRUST, REGULARITY = 0.5, 1e-3
"""Trust region [px] and lambda of the timed iterations; neither changes their cost."""


@dataclass(frozen=True)
class Timing:
    """Wall times of one thing done several times [ms]."""

    median: float
    """The usual case."""
    minimum: float
    """The machine at its best."""


def repeat(action: Callable[[], object], times: int, *, per_call: int = 1) -> Timing:
    """Time an action after one run that does not count.

    Args:
        action: What to time.
        times: How often.
        per_call: Divides the times, for an action that does a thing several times over.
    """
    action()
    samples = []
    for _ in range(times):
        begun = perf_counter()
        action()
        samples.append(1e3 * (perf_counter() - begun) / per_call)
    return Timing(median(samples), min(samples))


def machine() -> str:
    """Name and number of the processors."""
    cpuinfo = Path("/proc/cpuinfo")
    text = cpuinfo.read_text(encoding="utf-8") if cpuinfo.exists() else ""
    names = re.findall(r"^model name\s*:\s*(.+)$", text, flags=re.MULTILINE)
    if not names:
        return f"{platform.processor() or platform.machine()}"
    return f"{names[0].strip()}, {len(names)} processors"


def read_picture(path: Path, size: tuple[int, int] | None = None) -> np.ndarray:
    """Read a still as RGB code values, [H, W, 3] uint8.

    Args:
        path: The file.
        size: Width and height to scale it to [px], or None.
    """
    encoded = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    picture = cv2.imdecode(encoded, cv2.IMREAD_COLOR)
    if picture is None:
        raise SystemExit(f"{path}: no picture that OpenCV reads")
    if size is not None:
        shrinks = size[0] < picture.shape[1]
        picture = cv2.resize(
            picture, size, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_CUBIC
        )
    return cv2.cvtColor(picture, cv2.COLOR_BGR2RGB)


def layout_of(picture: np.ndarray, triangles: int) -> Mesh:
    """A mesh to time: importance sampling of a picture, with a fixed seed."""
    return Importance().build(picture, triangles, np.random.default_rng(0))


def loaded_workspace(
    device: Device, picture: np.ndarray, mesh: Mesh, model: ColorModel, sums: str = "edges"
) -> Workspace:
    """A workspace that holds a picture and a mesh."""
    workspace = Workspace(device, (picture.shape[1], picture.shape[0]), model, sums)
    workspace.load_image(picture)
    load_mesh(workspace, mesh)
    return workspace


def time_iteration(workspace: Workspace, mesh: Mesh, *, steps: int, times: int) -> Timing:
    """Time one full iteration: moments, energies, gradient, step of every vertex.

    Args:
        workspace: Holds the picture; the mesh is put back before every sample.
        mesh: The mesh.
        steps: Iterations run at a stretch; the time is that of one of them.
        times: Samples.
    """
    device = workspace.device
    samples = []
    for _ in range(times + 1):
        load_mesh(workspace, mesh)
        device.synchronize()
        begun = perf_counter()
        workspace.iterate(steps, trust=TRUST, regularity=REGULARITY)
        device.synchronize()
        samples.append(1e3 * (perf_counter() - begun) / steps)
    return Timing(median(samples[1:]), min(samples[1:]))


def table(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Lay out rows as a Markdown table with aligned columns."""
    cells = [list(heads), *([str(cell) for cell in row] for row in rows)]
    widths = [max(len(row[n]) for row in cells) for n in range(len(heads))]
    lines = [
        "| " + " | ".join(c.rjust(w) for c, w in zip(r, widths, strict=True)) + " |" for r in cells
    ]
    lines.insert(1, "|" + "|".join("-" * (w + 1) + ":" for w in widths) + "|")
    return "\n".join(lines)


def program(description: str) -> argparse.ArgumentParser:
    """A command line whose help is the program's docstring."""
    return argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
