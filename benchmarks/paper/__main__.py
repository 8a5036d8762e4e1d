"""Redo the paper's experiments and write docs/results/paper.md with its plots.

    python -m benchmarks.paper [--images FOLDER] [--out docs/results] [--only fig8,fig9]

Run in the root of the repository. Without a folder the pictures are stills of the sample clips.
"""

import argparse
from pathlib import Path
from time import perf_counter

from benchmarks.paper.experiments import EXPERIMENTS
from benchmarks.paper.page import Section, write_page
from benchmarks.paper.pictures import folder_pictures, sample_pictures
from benchmarks.paper.study import Study
from benchmarks.timing import program
from warp_kernels.device.device import Device

RESULTS = Path(__file__).parents[2] / "docs" / "results"


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("--images", type=Path, metavar="FOLDER", help="stills to use instead")
    parser.add_argument("--out", type=Path, default=RESULTS, metavar="FOLDER")
    parser.add_argument("--only", default=",".join(EXPERIMENTS), metavar="NAME,NAME")
    parser.add_argument("--triangles", type=int, nargs="+", default=[300, 700, 1500])
    parser.add_argument("--iterations", type=int, help="at most, to try things out quickly")
    parser.add_argument("--device", default="cpu", metavar="auto|cpu|cuda:N")
    parser.add_argument("--threads", type=int, default=0, help="0 for one per core")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    unknown = sorted(set(options.only.split(",")) - EXPERIMENTS.keys())
    if unknown:
        parser.error(f"--only {unknown[0]}: unknown; choose from {', '.join(EXPERIMENTS)}")
    return options


def main() -> None:
    """Run the experiments in turn and write the page."""
    options = parse()
    study = Study(
        pictures=folder_pictures(options.images) if options.images else sample_pictures(),
        device=Device(options.device, options.threads),
        plots=options.out / "paper",
        counts=tuple(options.triangles),
        seed=options.seed,
        iterations=options.iterations,
        say=lambda text: print(text, flush=True),
    )
    sections: list[Section] = []
    begun = perf_counter()
    for name, experiment in EXPERIMENTS.items():
        if name in options.only.split(","):
            study.say(f"{name}: {experiment.__name__}")
            sections.append(experiment().run(study))
            study.say(f"  done after {perf_counter() - begun:.0f} s")
    command = "python -m benchmarks.paper" + (" --images FOLDER" if options.images else "")
    write_page(options.out / "paper.md", study, sections, command)
    study.say(f"{options.out / 'paper.md'}")


if __name__ == "__main__":
    main()
