"""Measure what the cost of an iteration follows: the total length of the edges, not the pixels.

    python benchmarks/scaling.py [--write] [--plot OUT.png] [--image PICTURE]

Sizes from 128x128 to 3840x2160, 100 to 20,000 triangles, constant and linear colours. `--write`
puts the table and the plot into docs/results/scaling.md and .png.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from timing import (
    DEFAULT_PICTURE,
    Timing,
    layout_of,
    loaded_workspace,
    machine,
    program,
    read_picture,
    table,
    time_iteration,
)

from stages.mesh import Mesh
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device

RESULTS = Path(__file__).parents[1] / "docs" / "results"
SIZES = ((128, 128), (256, 256), (512, 512), (1280, 720), (1920, 1080), (3840, 2160))
COUNTS = (100, 700, 5_000, 20_000)
PIXELS_PER_TRIANGLE = 6
"""Meshes with fewer pixels to a triangle than this are left out: nobody wants them."""
HEADS = (
    "picture",
    "triangles",
    "Mpixels",
    "edge length [kpx]",
    "constant [ms]",
    "linear [ms]",
    "constant [ns/px of edge]",
    "constant [ns/pixel]",
)


@dataclass(frozen=True)
class Point:
    """One size and one number of triangles."""

    size: tuple[int, int]
    """Width and height [px]."""
    triangles: int
    """Triangles of the mesh."""
    edge_length: float
    """Sum over its edges [px]."""
    timings: dict[str, Timing]
    """By colour model."""

    @property
    def pixels(self) -> int:
        """Pixels of the picture."""
        return self.size[0] * self.size[1]

    def row(self) -> tuple[str, ...]:
        """What the table says."""
        constant, linear = (self.timings[name].median for name in ("constant", "linear"))
        return (
            "{}x{}".format(*self.size),
            f"{self.triangles:,}",
            f"{self.pixels / 1e6:.2f}",
            f"{self.edge_length / 1e3:.1f}",
            f"{constant:.3f}",
            f"{linear:.3f}",
            f"{1e6 * constant / self.edge_length:.1f}",
            f"{1e6 * constant / self.pixels:.2f}",
        )


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("--image", type=Path, default=DEFAULT_PICTURE, metavar="PICTURE")
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, default=0, help="0 for one per core")
    parser.add_argument("--samples", type=int, default=7)
    parser.add_argument("--plot", type=Path, metavar="OUT.png")
    parser.add_argument("--write", action="store_true", help="write docs/results/scaling.*")
    return parser.parse_args()


def total_edge_length(mesh: Mesh) -> float:
    """Sum of the lengths of all edges [px]."""
    ends = mesh.vertices[mesh.edge_vertices]
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


def measure(options: argparse.Namespace) -> list[Point]:
    """Time every size with every number of triangles that fits."""
    device = Device(options.device, options.threads)
    points = []
    for size in SIZES:
        picture = read_picture(options.image, size)
        for count in COUNTS:
            if count * PIXELS_PER_TRIANGLE > size[0] * size[1]:
                continue
            mesh = layout_of(picture, count)
            timings = {
                name: time_iteration(
                    loaded_workspace(device, picture, mesh, model),
                    mesh,
                    steps=10,
                    times=options.samples,
                )
                for name, model in COLOR_MODELS.items()
            }
            points.append(Point(size, mesh.triangle_count, total_edge_length(mesh), timings))
    return points


def slope(x: list[float], y: list[float]) -> tuple[float, float]:
    """Exponent of a power law through points, and the correlation of the logarithms."""
    u, v = np.log(x), np.log(y)
    return float(np.polyfit(u, v, 1)[0]), float(np.corrcoef(u, v)[0, 1])


def plot(points: list[Point], path: Path, title: str) -> None:
    """Draw cost against edge length and against pixels, side by side."""
    mpl.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, 2, figsize=(11, 4.6), sharey=True)
    for panel, label, value in (
        (panels[0], "total edge length [px]", lambda point: point.edge_length),
        (panels[1], "pixels of the picture", lambda point: point.pixels),
    ):
        for size in SIZES:
            chosen = [point for point in points if point.size == size]
            cost = [point.timings["constant"].median for point in chosen]
            name = "{}x{}".format(*size)
            panel.loglog([value(point) for point in chosen], cost, "o-", label=name)
        panel.set_xlabel(label)
        panel.grid(True, which="both", alpha=0.25)
    panels[0].set_ylabel("one iteration, constant colours [ms]")
    panels[0].legend()
    figure.suptitle(title, fontsize=9)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the table; write what was asked for."""
    options = parse()
    points = measure(options)
    cost = [point.timings["constant"].median for point in points]
    by_length = slope([point.edge_length for point in points], cost)
    by_pixels = slope([float(point.pixels) for point in points], cost)
    title = f"{machine()}; {Device(options.device, options.threads)!r}"
    text = "\n".join(
        (
            table(HEADS, [point.row() for point in points]),
            "",
            "Power law of the cost, constant colours (exponent, correlation of logarithms):",
            "edge length {:.2f}, {:.3f}; pixels {:.2f}, {:.3f}.".format(*by_length, *by_pixels),
        )
    )
    print(f"{title}\n\n{text}")
    if options.plot:
        plot(points, options.plot, title)
    if options.write:
        plot(points, RESULTS / "scaling.png", title)
        page = f"# How the cost of an iteration scales\n\n{title}. Medians; `benchmarks/scaling.py`"
        page += f" writes this page.\n\n{text}\n\n![cost of an iteration](scaling.png)\n"
        (RESULTS / "scaling.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
