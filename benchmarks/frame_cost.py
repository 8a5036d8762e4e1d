"""What a later frame of a clip costs, where that goes, and what it follows.

    python benchmarks/frame_cost.py [CLIP] [--before CHECKOUT] [--write] [--frames 12]

Seconds are those of processors: those of a run minus those of a shorter run, so that neither the
start nor the first frame counts. Stages are timed in the threads that call them; the team's other
threads, the decoder and the encoder are what is left. `--before` names another checkout of the
program, which is measured in turn with this one. `--write` puts tables and plot into
docs/results/frame_cost.md and .png.
"""

import argparse
import json
import os
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import wraps
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from time import thread_time
from typing import Any

import av
import matplotlib as mpl
import numpy as np

if sys.argv[1:2] != ["--run"]:  # in another checkout what it imports may lie elsewhere
    from timing import machine, program, table

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "docs" / "results"
SIZES = ((320, 180), (640, 360), (1280, 720), (1920, 1080), (3840, 2160))
COUNTS = (300, 1_500, 5_000, 10_000)
SHARES = (0.0, 0.05, 0.2, 0.5, 1.0)
TABLED = ((1280, 720, 1_500), (1920, 1080, 1_500), (3840, 2160, 3_000))
"""Width, height and triangles of the table of stages."""
SHORT = 3
"""Frames of the shorter run; the first of them starts a mesh."""
BEYOND = 12
"""Frames of a clip after those that are converted: both runs look as far ahead."""
STAGES = (
    ("pixels to RGB", "RgbReader.read8"),
    ("cuts", "signature"),
    ("motion", "Passage.between"),
    ("carry the mesh", "advect"),
    ("load the picture", "Workspace.load_image"),
    ("solve", "Triangulator.next"),
    ("draw", "Renderer.render"),
    ("RGB to YUV", "YuvWriter.write"),
)
"""Name of a stage, and the function that is it, wherever a checkout has it."""
LOOPS = ("pipeline.loop.convert", "pipeline.animate")
"""The module of the loop over time, today and before 0.2."""


@dataclass(frozen=True)
class Cost:
    """Of one later frame."""

    total: float
    """Of all threads [CPU ms]."""
    stages: dict[str, float]
    """Of the calling threads [CPU ms], by stage."""


def watch(spent: dict[str, float]) -> None:
    """Add what the stages take to `spent` from now on [s]."""
    for stage, path in STAGES:
        outer, _, name = path.rpartition(".")
        module = _home_of(outer or name)
        _watch_one(spent, stage, getattr(module, outer) if outer else module, name)


def _home_of(name: str) -> Any:
    """The module that defines a class or function of the program."""
    for place, module in list(sys.modules.items()):
        is_ours = place.startswith(("pipeline.", "stages.", "warp_kernels."))
        if is_ours and getattr(getattr(module, name, None), "__module__", None) == place:
            return module
    raise SystemExit(f"{name}: not found")


def _watch_one(spent: dict[str, float], stage: str, owner: Any, name: str) -> None:
    raw = vars(owner)[name]
    is_of_class = isinstance(raw, classmethod)
    function: Callable[..., Any] = raw.__func__ if is_of_class else raw

    @wraps(function)
    def timed(*args: Any, **kwargs: Any) -> Any:
        begun = thread_time()
        try:
            return function(*args, **kwargs)
        finally:
            spent[stage] += thread_time() - begun

    setattr(owner, name, classmethod(timed) if is_of_class else timed)
    for module in list(sys.modules.values()):  # and wherever it was imported by name
        if getattr(module, name, None) is raw:
            setattr(module, name, timed)


def run_here(arguments: list[str]) -> None:
    """Convert in this process, and print what it took as JSON."""
    for loop in LOOPS:
        with suppress(ModuleNotFoundError):
            import_module(loop)
    spent: dict[str, float] = defaultdict(float)
    watch(spent)
    code = import_module("pipeline.cli").main([*arguments, "--progress", "none"])
    times = os.times()
    print(json.dumps({"total": times.user + times.system, "stages": spent}))
    raise SystemExit(code)


def cost_of(tree: Path, clip: Path, triangles: int, frames: int) -> Cost:
    """What a later frame of a clip costs in a checkout of the program."""
    short, long = (_run(tree, clip, triangles, SHORT + more) for more in (0, frames))
    stages = {
        name: 1e3 * (long["stages"].get(name, 0.0) - short["stages"].get(name, 0.0)) / frames
        for name, _ in STAGES
    }
    stages["solve"] -= stages["load the picture"]  # which is a part of it
    return Cost(1e3 * (long["total"] - short["total"]) / frames, stages)


def _run(tree: Path, clip: Path, triangles: int, frames: int) -> dict[str, Any]:
    output = clip.with_name("out.mp4")
    command = [sys.executable, str(Path(__file__).resolve()), "--run", "animate", str(clip)]
    command += ["-o", str(output), "--overwrite", "--triangles", str(triangles), "--no-audio"]
    command += ["--frames", f"0-{frames - 1}"]
    if tree == ROOT:  # an older one looks for no faces, and has no such option
        command += ["--focus", "none"]
    inside = {**os.environ, "PYTHONPATH": str(tree)}
    done = subprocess.run(
        command, cwd=tree, env=inside, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}: {done.stderr}")
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def scaled_clip(source: Path, path: Path, size: tuple[int, int], count: int, share: float) -> Path:
    """Write the first frames of a clip at a size; beside a window they all show the first one.

    Args:
        source: The clip.
        path: Where to write.
        size: Width and height [px].
        count: Number of frames.
        share: Part of the picture that the window covers.
    """
    width, height = size
    part = np.sqrt(share)
    rows = slice(round(height * (1 - part) / 2), round(height * (1 + part) / 2))
    columns = slice(round(width * (1 - part) / 2), round(width * (1 + part) / 2))
    shown: np.ndarray | None = None
    with av.open(str(source)) as given, av.open(str(path), "w") as made:
        stream = made.add_stream("libx264", rate=25, options={"crf": "8", "preset": "ultrafast"})
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        for number, frame in zip(range(count), given.decode(video=0), strict=False):
            pixels = frame.to_ndarray(format="rgb24", width=width, height=height)
            shown = pixels.copy() if shown is None else shown
            shown[rows, columns] = pixels[rows, columns]
            picture = av.VideoFrame.from_ndarray(shown, format="rgb24")
            picture.pts = number
            made.mux(stream.encode(picture))
        made.mux(stream.encode(None))
    return path


def stage_table(clip: Path, folder: Path, before: Path | None, frames: int) -> str:
    """Where the time of a later frame goes, in this checkout and in another one."""
    rows: list[list[str]] = [[name] for name, _ in STAGES]
    rows += [["other threads"], ["**all**"]]
    heads = ["CPU ms a frame"]
    for width, height, triangles in TABLED:
        made = scaled_clip(clip, folder / "a.mp4", (width, height), SHORT + frames + BEYOND, 1.0)
        for tree in (before, ROOT) if before else (ROOT,):
            assert tree is not None
            cost = cost_of(tree, made, triangles, frames)
            heads.append(f"{height}p" + (", before" if tree is before else ""))
            left = cost.total - sum(cost.stages.values())
            for row, value in zip(rows, [*cost.stages.values(), left, cost.total], strict=True):
                row.append(f"{value:.1f}")
    return table(heads, rows)


def sweep(clip: Path, folder: Path, frames: int) -> dict[str, list[tuple[float, float]]]:
    """Cost of a later frame [CPU ms] by pixels, by triangles and by the share that changes."""
    found: dict[str, list[tuple[float, float]]] = {"pixels": [], "triangles": [], "share": []}
    middle = SIZES[2]

    def cost(size: tuple[int, int], triangles: int, share: float) -> float:
        """Of a later frame."""
        made = scaled_clip(clip, folder / "b.mp4", size, SHORT + frames + BEYOND, share)
        return cost_of(ROOT, made, triangles, frames).total

    usual = cost(middle, COUNTS[1], 1.0)
    for size in SIZES:
        value = usual if size == middle else cost(size, COUNTS[1], 1.0)
        found["pixels"].append((size[0] * size[1], value))
    for count in COUNTS:
        found["triangles"].append((count, usual if count == COUNTS[1] else cost(middle, count, 1)))
    for share in SHARES:
        found["share"].append((share, usual if share == 1 else cost(middle, COUNTS[1], share)))
    return found


def plot(found: dict[str, list[tuple[float, float]]], path: Path, title: str) -> None:
    """Draw the three side by side."""
    mpl.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, 3, figsize=(12, 4.2))
    labels = (
        "pixels (1,500 triangles)",
        "triangles (1280x720)",
        "share that changes (1280x720, 1,500)",
    )
    for panel, label, (kind, points) in zip(panels, labels, found.items(), strict=True):
        x, y = zip(*points, strict=True)
        panel.plot(x, y, "o-") if kind == "share" else panel.loglog(x, y, "o-")
        panel.set_ylim(bottom=0 if kind == "share" else None)
        panel.set_xlabel(label)
        panel.grid(True, which="both", alpha=0.25)
    panels[0].set_ylabel("a later frame [CPU ms]")
    figure.suptitle(title, fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the tables; write what was asked for."""
    if sys.argv[1:2] == ["--run"]:
        run_here(sys.argv[2:])
    parser: argparse.ArgumentParser = program(__doc__ or "")
    parser.add_argument(
        "clip", nargs="?", type=Path, default=ROOT / "sample_videos/bigbuckbunny.mp4"
    )
    parser.add_argument("--before", type=Path, metavar="CHECKOUT")
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--write", action="store_true", help="write docs/results/frame_cost.*")
    options = parser.parse_args()
    with TemporaryDirectory() as name:
        stages = stage_table(options.clip, Path(name), options.before, options.frames)
        print(stages, flush=True)
        found = sweep(options.clip, Path(name), options.frames)
    swept = "\n\n".join(
        table([kind, "CPU ms a frame"], [[f"{x:g}", f"{y:.0f}"] for x, y in points])
        for kind, points in found.items()
    )
    print(swept)
    if options.write:
        title = f"{machine()}; {options.clip.name}"
        plot(found, RESULTS / "frame_cost.png", title)
        page = (
            f"# What a later frame costs\n\n{title}. `benchmarks/frame_cost.py` writes this page."
        )
        page += f"\n\n{stages}\n\n![cost of a frame](frame_cost.png)\n\n{swept}\n"
        (RESULTS / "frame_cost.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
