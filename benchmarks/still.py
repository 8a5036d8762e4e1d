"""Measure stills: the error that is left and the seconds it took, by number of triangles.

    python benchmarks/still.py [PICTURE ...] [--triangles 200 700 1500] [--color constant]

The seconds are those of the first frame's triangulation, from the decoded picture to the fitted
colours, after one small run that does not count, so compilation and start-up are left out. The
rmse is over pixels and channels [code values], before colours are rounded.
"""

import argparse
from fractions import Fraction
from pathlib import Path
from time import perf_counter

import numpy as np
from timing import DEFAULT_PICTURE, machine, program, read_picture, table

from stages.frame import Frame
from stages.layouts import LAYOUTS
from stages.topology import TOPOLOGIES
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device

HEADS = ("picture", "wanted", "triangles", "rmse", "seconds")


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("pictures", type=Path, nargs="*", default=[DEFAULT_PICTURE])
    parser.add_argument("--triangles", type=int, nargs="+", default=[200, 700, 1500])
    parser.add_argument("--color", choices=COLOR_MODELS, default="constant")
    parser.add_argument("--topology", choices=TOPOLOGIES, default=TriangulateOptions.topology)
    parser.add_argument("--layout", choices=LAYOUTS, default="importance")
    parser.add_argument("--iterations", type=int, default=TriangulateOptions.iterations)
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, default=0, help="0 for one per core")
    parser.add_argument("--seed", type=int, default=0)
    return parser.parse_args()


def solve(picture: np.ndarray, options: argparse.Namespace, count: int, iterations: int) -> tuple:
    """Triangulate a picture; triangles, rmse [code values] and time [s]."""
    wanted = TriangulateOptions(
        color=options.color,
        topology=options.topology,
        iterations=iterations,
        refine=RefineOptions(triangles=count),
    )
    size = (picture.shape[1], picture.shape[0])
    triangulator = Triangulator(Device(options.device, options.threads), size, wanted)
    frame = Frame(0, 0, Fraction(1, 25), picture)
    begun = perf_counter()
    rng = np.random.default_rng([options.seed, 0])
    snapshot = triangulator.first(frame, LAYOUTS[options.layout](), rng)
    return snapshot.mesh.triangle_count, snapshot.rmse, perf_counter() - begun


def main() -> None:
    """Print the table."""
    options = parse()
    print(f"{machine()}; {options.color}, {options.topology}, {options.iterations} iterations\n")
    rows = []
    for path in options.pictures:
        picture = read_picture(path)
        solve(picture, options, count=50, iterations=20)
        for count in options.triangles:
            triangles, rmse, seconds = solve(picture, options, count, options.iterations)
            rows.append((path.name, count, triangles, f"{rmse:.2f}", f"{seconds:.2f}"))
    print(table(HEADS, rows))


if __name__ == "__main__":
    main()
