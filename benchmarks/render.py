"""Measure drawing: milliseconds a frame for stacks of styles.

    python benchmarks/render.py [PICTURE] [--size 1280x720] [--triangles 1500] [--style SPEC ...]

Solving, decoding and encoding are left out. Each line of the table is one stack; `--style`, which
may be repeated, puts one of your own in their place. The stacks take turns frame by frame, so a
machine that is busy for a while slows all of them alike.
"""

import argparse
from fractions import Fraction
from pathlib import Path
from statistics import median
from time import perf_counter

from timing import (
    DEFAULT_PICTURE,
    layout_of,
    loaded_workspace,
    machine,
    program,
    read_picture,
    table,
)

from pipeline.options.members import parse_member
from stages.look.output_size import parse_size
from stages.render import Renderer
from stages.snapshot import Snapshot
from warp_kernels.color_model import LINEAR
from warp_kernels.device.device import Device
from warp_kernels.styles import STYLES

STACKS = (("flat",), ("flat", "edges"), ("gradient",), ("hatching",), ("texture",), ("lenses",))
"""What is measured unless `--style` asks for something else."""
HEADS = ("styles", "ms a frame", "at best")


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("picture", type=Path, nargs="?", default=DEFAULT_PICTURE)
    parser.add_argument("--size", type=parse_size, default=(1280, 720), metavar="WxH")
    parser.add_argument("--triangles", type=int, default=1500)
    parser.add_argument("--style", action="append", metavar="SPEC")
    parser.add_argument("--frames", type=int, default=40, help="frames timed for each stack")
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, default=0, help="0 for one per core")
    return parser.parse_args()


def main() -> None:
    """Print the table."""
    options = parse()
    device = Device(options.device, options.threads)
    picture = read_picture(options.picture, options.size)
    mesh = layout_of(picture, options.triangles)
    fit = loaded_workspace(device, picture, mesh, LINEAR).fit()
    snapshot = Snapshot(0, 0, Fraction(1, 25), mesh, LINEAR, *fit)
    stacks = (tuple(options.style),) if options.style else STACKS
    times: dict[tuple[str, ...], list[float]] = {stack: [] for stack in stacks}
    renderers = {}
    for stack in stacks:
        styles = tuple(parse_member("--style", spec, STYLES) for spec in stack)
        renderers[stack] = Renderer(device, options.size, options.size, styles)
        renderers[stack].render(snapshot, source=picture)
    for _ in range(options.frames):
        for stack, renderer in renderers.items():
            begun = perf_counter()
            renderer.render(snapshot, source=picture)
            times[stack].append(1e3 * (perf_counter() - begun))
    width, height = options.size
    print(f"{machine()}; {width}x{height}, {mesh.triangle_count} triangles\n")
    rows = [(" + ".join(s), f"{median(t):.1f}", f"{min(t):.1f}") for s, t in times.items()]
    print(table(HEADS, rows))


if __name__ == "__main__":
    main()
