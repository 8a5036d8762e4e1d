"""The first minutes on a card: proves the bits, finds faults of streams, and measures.

    python -m benchmarks.card [--device cuda:0] [--out FOLDER] [--seconds 560]

Stages come in the order of what they tell. Each prints as it ends, and what is known so far lies in
FOLDER/card.json: a run that is cut short loses little. A stage that fails is told, and the next one
begins; none begins after `--seconds`. With `--device cuda-emulated` it tries itself out without a
card, for which nothing it measures means anything.
"""

import argparse
import json
import subprocess
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from threading import Thread
from time import perf_counter
from typing import Any

import numpy as np
import warp as wp

from pipeline.loop.animate import animate
from pipeline.progress import Progress
from stages.media import open_decoder
from stages.media.frame_range import FrameRange
from stages.media.writing.encode_options import EncodeOptions
from stages.optimize import load_mesh
from stages.render import Renderer
from tests.jobs import job_of
from tests.kernel_samples import (
    poisoned_workspace,
    random_mesh,
    random_weights,
    snapshot_of,
    waves,
)
from warp_kernels.color_model import COLOR_MODELS, LINEAR
from warp_kernels.device.device import Device
from warp_kernels.energy.workspace import Workspace
from warp_kernels.errors import TrimotionError
from warp_kernels.styles import STYLES

CLIP = Path(__file__).parents[1] / "sample_videos" / "bigbuckbunny.mp4"
PARTS = ("color sums", "area sums", "energies", "coefficients", "fit", "counts", "vertices")
STEP = {"trust": 0.5, "regularity": 1e-3}


@dataclass(frozen=True)
class Trial:
    """What a stage works with."""

    device: str
    folder: Path
    small: bool
    """Whether to do little: on an emulated card."""

    def both(self) -> Iterator[Device]:
        """The CPU, and the card beside it."""
        yield from (Device("cpu"), Device(self.device))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run all stages; 1 if one found a fault."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--device", default="cuda:0")
    parser.add_argument("--out", type=Path, default=Path("out/card"), metavar="FOLDER")
    parser.add_argument("--seconds", type=float, default=560.0)
    options = parser.parse_args(arguments)
    problem = missing(options.device)
    if problem:
        print(problem, file=sys.stderr)
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    trial = Trial(options.device, options.out, "emulated" in options.device)
    begun, found, faults = perf_counter(), {}, 0
    for stage in STAGES:
        name = (stage.__doc__ or "").split(".")[0]
        if perf_counter() - begun > options.seconds:
            print(f"-- {name}: no time left")
            continue
        start = perf_counter()
        try:
            result = stage(trial)
        except Exception:  # the next stage may still tell something
            result, faults = {"failed": traceback.format_exc()}, faults + 1
        found[name] = result
        print(f"== {name} ({perf_counter() - start:.1f} s)", flush=True)
        for key, value in result.items():
            print(f"   {key}: {value}", flush=True)
        faults += sum(1 for value in result.values() if value == DIFFERENT)
        text = json.dumps(found, indent=1, default=str)
        (options.out / "card.json").write_text(text, encoding="utf-8")
    print(f"{faults} faults" if faults else "no fault was found")
    return 1 if faults else 0


def missing(device: str) -> str:
    """Why nothing can be measured here, in one line; nothing if it can."""
    try:
        found = Device(device)
    except TrimotionError as error:
        return f"benchmarks.card: {error}"
    if not found.is_cuda:
        return f"benchmarks.card: --device {device} is no card; name one such as cuda:0"
    return ""


SAME, DIFFERENT = "the same bits", "DIFFERENT"


def told(pairs: Sequence[tuple[Any, Any]]) -> str:
    """Whether all pairs of arrays are equal."""
    return SAME if all(np.array_equal(a, b) for a, b in pairs) else DIFFERENT


def machine(trial: Trial) -> dict[str, Any]:
    """The machine."""
    device = Device(trial.device)
    asked = ["nvidia-smi", "--query-gpu=name,driver_version,clocks.sm", "--format=csv,noheader"]
    try:
        card = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        card = f"nvidia-smi does not run ({error})"
    versions = wp.get_cuda_driver_version(), wp.get_cuda_toolkit_version()
    return {"card": card, "device": device, "driver, toolkit": versions, "Warp": wp.config.version}


def solver_bits(trial: Trial) -> dict[str, Any]:
    """Bits of the solver against the CPU. Sums, energies, fit, vertices after 50 iterations."""
    size, found = (64, 48) if trial.small else (320, 240), {}
    mesh = random_mesh(*size, 40 if trial.small else 400)
    for name, model in COLOR_MODELS.items():
        for weights in (None, random_weights(*size)):
            results = []
            for device in trial.both():
                workspace = poisoned_workspace(device, waves(*size), mesh, model, weights=weights)
                first = [*workspace.moments(), workspace.energies(), *workspace.fit()]
                workspace.hold(np.zeros((mesh.vertex_count, 4)))
                workspace.iterate(50, **STEP)
                results.append([*first, workspace.vertices()])
            odd = [p for p, a, b in zip(PARTS, *results, strict=True) if not np.array_equal(a, b)]
            key = f"{name}{'' if weights is None else ' with weights'}"
            found[key] = DIFFERENT if odd else SAME
            if odd:
                found[f"{key}: different are"] = ", ".join(odd)
    return found


def iterations(trial: Trial) -> dict[str, Any]:
    """Time of an iteration [ms]."""
    found = {}
    sizes = ((64, 40),) if trial.small else ((512, 340), (1920, 750), (1920, 5000))
    for side, inner in sizes:
        mesh = random_mesh(side, side, inner)
        for name, model in COLOR_MODELS.items():
            for device in trial.both():
                workspace = poisoned_workspace(device, waves(side, side), mesh, model)
                workspace.hold(np.zeros((mesh.vertex_count, 4)))
                times = [_timed(workspace, lambda w: w.iterate(100, **STEP)) for _ in range(4)]
                key = f"{side}x{side}, {mesh.triangle_count} triangles, {name}, {device.name}"
                found[key] = round(10 * min(times[1:]), 4)
    return found


def _timed(workspace: Workspace, work: Callable[[Workspace], object]) -> float:
    """Seconds until all of it is done."""
    workspace.device.synchronize()
    begun = perf_counter()
    work(workspace)
    workspace.device.synchronize()
    return perf_counter() - begun


def pictures(trial: Trial) -> dict[str, Any]:
    """Pictures of all styles. Share of pixels that differ, the largest difference, and [ms]."""
    found: dict[str, Any] = {}
    for size in ((64, 48),) if trial.small else ((320, 180), (1920, 1080)):
        mesh = random_mesh(*size, 40 if trial.small else 750)
        snapshot = snapshot_of(Device("cpu"), waves(*size), mesh, LINEAR)
        for name in STYLES:
            drawn, times = [], []
            for device in trial.both():
                styles = (STYLES["flat"](), STYLES[name]())
                renderer = Renderer(device, size, size, styles)
                drawn.append(renderer.render(snapshot, source=waves(*size)).astype(int))
                begun = perf_counter()
                renderer.render(snapshot, source=waves(*size))
                times.append(round(1e3 * (perf_counter() - begun), 2))
            off = np.abs(drawn[0] - drawn[1])
            shares = f"{(off > 0).any(axis=2).mean():.4%} of pixels, at most {off.max()}"
            found[f"{size[0]}x{size[1]} {name}"] = f"{shares}; CPU {times[0]} ms, card {times[1]}"
    return found


def round_parts(trial: Trial) -> dict[str, Any]:
    """Where the time of a round goes at 720p, 1,500 triangles [ms]."""
    size = (64, 48) if trial.small else (1280, 720)
    mesh = random_mesh(*size, 40 if trial.small else 750)
    workspace = poisoned_workspace(Device(trial.device), waves(*size), mesh, LINEAR)
    workspace.hold(np.zeros((mesh.vertex_count, 4)))
    workspace.iterate(10, **STEP)
    picture = waves(*size)
    parts: dict[str, Callable[[Workspace], object]] = {
        "load the picture": lambda w: w.load_image(picture),
        "load the mesh": lambda w: load_mesh(w, mesh),
        "four iterations and vertices": lambda w: (w.iterate(4, **STEP), w.vertices()),
        "energies": lambda w: w.energies(),
    }
    times = {n: [_timed(workspace, part) for _ in range(15)][1:] for n, part in parts.items()}
    found: dict[str, Any] = {name: round(1e3 * median(some), 4) for name, some in times.items()}
    if not trial.small:
        with wp.ScopedTimer("", print=False, cuda_filter=wp.TIMING_ALL) as timer:
            load_mesh(workspace, mesh)
            workspace.iterate(1, **STEP)
            workspace.fit()
        for part in timer.timing_results:
            found[f"kernel or copy {part.name}"] = round(part.elapsed, 4)
    return found


def two_threads(trial: Trial) -> dict[str, Any]:
    """Two threads on one card. One solves, one draws, each on a stream of its own."""
    device, size = Device(trial.device), (64, 48) if trial.small else (1280, 720)
    mesh, errors = random_mesh(*size, 60), []
    snapshot = snapshot_of(device, waves(*size), mesh, LINEAR)
    renderer = Renderer(device.beside(), size, size, (STYLES["flat"](),))
    expected = renderer.render(snapshot)

    def draw() -> None:
        """Draw the same again and again."""
        try:
            for _ in range(60):
                if not np.array_equal(renderer.render(snapshot), expected):
                    errors.append("a picture differs")
        except Exception as error:  # told below
            errors.append(repr(error))

    def solve() -> None:
        """Solve meshes that grow, which are captured again and again."""
        for number in range(40):
            grown = random_mesh(*size, 20 + 10 * number)
            workspace = poisoned_workspace(device, waves(*size), grown, LINEAR)
            workspace.hold(np.zeros((grown.vertex_count, 4)))
            workspace.iterate(5, **STEP)
            workspace.fit()

    solve()  # kernels are compiled
    alone = [_seconds(work) for work in (draw, solve)]
    drawing = Thread(target=draw, daemon=True)
    begun = perf_counter()
    drawing.start()
    solve()
    drawing.join(60)
    both = perf_counter() - begun
    return {
        "errors": errors[:3] or SAME,
        "both ended": "no" if drawing.is_alive() else "yes",
        "drawing alone, solving alone, both at once [s]": [round(t, 3) for t in (*alone, both)],
    }


def _seconds(work: Callable[[], object]) -> float:
    """How long something takes."""
    begun = perf_counter()
    work()
    return perf_counter() - begun


def clips(trial: Trial) -> dict[str, Any]:
    """A whole clip, against the CPU. Frames that differ, and frames a second."""
    last = 1 if trial.small else 59
    films, found = [], {}
    for name in ("cpu", trial.device):
        output = trial.folder / f"{name.replace(':', '-')}.mkv"
        job = job_of(
            CLIP,
            output,
            frame_range=FrameRange(0, last),
            encode=EncodeOptions(codec="ffv1", overwrite=True),
            device=name,
        )
        begun = perf_counter()
        animate(job, Progress())
        found[f"{name}, frames a second"] = round((last + 1) / (perf_counter() - begun), 2)
        with open_decoder(output) as decoder:
            films.append([frame.pixels for frame in decoder])
    odd = [n for n, (a, b) in enumerate(zip(*films, strict=True)) if not np.array_equal(a, b)]
    found["frames"] = DIFFERENT if odd else SAME
    if odd:
        found["different frames"] = odd[:20]
    return found


STAGES: tuple[Callable[[Trial], dict[str, Any]], ...] = (
    machine,
    solver_bits,
    iterations,
    pictures,
    round_parts,
    two_threads,
    clips,
)

if __name__ == "__main__":
    sys.exit(main())
