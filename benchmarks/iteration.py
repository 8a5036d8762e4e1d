"""Time one full iteration of the optimiser, summed along edges and over fragments.

    python benchmarks/iteration.py [--image PICTURE] [--triangles 700] [--size 512x512]

One iteration is moments and energies of all thirteen variants, gradient and step of every vertex.
Both ways to sum run in the same process, by turns, for each colour model and number of threads.
The paper's GPU takes 3-15 ms (constant) and 6-24 ms (linear) at 512x512.
"""

import argparse
from pathlib import Path

from timing import (
    DEFAULT_PICTURE,
    layout_of,
    loaded_workspace,
    machine,
    program,
    read_picture,
    table,
    time_iteration,
)

from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device

HEADS = (
    "colours",
    "threads",
    "edges median [ms]",
    "edges min [ms]",
    "fragments median [ms]",
    "fragments min [ms]",
    "ratio of medians",
    "ratio of minima",
)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("--image", type=Path, default=DEFAULT_PICTURE, metavar="PICTURE")
    parser.add_argument("--triangles", type=int, default=700)
    parser.add_argument("--size", default="512x512", metavar="WxH")
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--samples", type=int, default=25, help="samples of 20 iterations")
    return parser.parse_args()


def main() -> None:
    """Print the table."""
    options = parse()
    width, height = (int(side) for side in options.size.split("x"))
    picture = read_picture(options.image, (width, height))
    mesh = layout_of(picture, options.triangles)
    print(f"{machine()}; {options.device}")
    print(f"{options.image.name} at {width}x{height}, {mesh.triangle_count} triangles\n")
    rows = []
    for model in COLOR_MODELS.values():
        for threads in options.threads:
            device = Device(options.device, threads)
            edges, fragments = (
                time_iteration(
                    loaded_workspace(device, picture, mesh, model, sums),
                    mesh,
                    steps=20 if sums == "edges" else 1,
                    times=options.samples if sums == "edges" else max(3, options.samples // 5),
                )
                for sums in ("edges", "fragments")
            )
            figures = (edges.median, edges.minimum, fragments.median, fragments.minimum)
            ratios = (fragments.median / edges.median, fragments.minimum / edges.minimum)
            rows.append(
                (model.name, threads, *(f"{f:.3f}" for f in figures), *(f"{r:.0f}" for r in ratios))
            )
    print(table(HEADS, rows))


if __name__ == "__main__":
    main()
