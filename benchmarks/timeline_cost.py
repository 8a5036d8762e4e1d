"""What twenty curves cost: a stack drawn with them and the same stack without, in turn.

Run it in the root of the repository: python benchmarks/timeline_cost.py [--rounds 5]
"""

import argparse
import statistics
import tempfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from time import perf_counter

import numpy as np

from pipeline.look.stage import Posed, open_stage
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.options.members import parse_member
from pipeline.options.solve_options import SolveOptions
from pipeline.timeline.staging import with_timeline
from pipeline.track import TrackReader
from stages.media import probe
from warp_kernels.device.device import Device
from warp_kernels.styles import STYLES

CLIP = Path("sample_videos/bigbuckbunny.mp4")
STACK = (
    "paper:color=#111,grain=0.3",
    "shrink:gap=2",
    "texture:cushion,strength=0.4",
    "incircles:opacity=0.4",
    "edges:width=1,fade=5",
    "edges:width=2,opacity=0.5",
)
CURVES = """
bpm = 120
[curves]
"paper.color" = "start: #111, end: #402"
"paper.grain" = "0.3 + 0.2*sin(t)"
"paper.size" = "start: 200, end: 300"
"paper.sheets" = "0.02 + 0.01*env(beat, decay=0.2s)"
"shrink.gap" = "1 + 4*env(beat, decay=0.25s)"
"shrink.smallest" = "start: 0.5, end: 0.6 ease-in"
"shrink.rounding" = "0.3 + 0.1*noise(1)"
"shrink.opacity" = "start: 0.9, end: 0.8"
"texture.strength" = "0.4 + 0.2*env(downbeat, decay=1 bar)"
"texture.opacity" = "0.8 - 0.1*progress"
"incircles.size" = "start: 0.8, 50%: 1.2 elastic, end: 1"
"incircles.opacity" = "0.3 + 0.1*random(floor(b))"
"edges[0].width" = "start: 1, 50%: 2 ease-in-out-cubic, end: 1"
"edges[0].color" = "start: #222, end: #a33"
"edges[0].fade" = "5 + sin(2*t)"
"edges[0].opacity" = "0.9 - 0.1*beat"
"edges[1].width" = "2 + env(every(2 beats), decay=0.5s)"
"edges[1].color" = "start: white, end: gold"
"edges[1].opacity" = "0.4 + 0.1*cos(t)"
"background" = "start: #000, end: #444"
"""


def seconds(job: Job, track: Path) -> float:
    """How long a frame of a track takes to be drawn in the mean [s], without encoding."""
    info = probe(CLIP)
    device = Device("auto", 0)
    framing = job.look.framing_for((info.width, info.height), info.sample_aspect)
    stage = open_stage(device, job, info, framing)
    with TrackReader(track) as reader, device:
        snapshots = [reader.snapshot(row.frame) for row in reader.rows]
        times = []
        for snapshot in snapshots:
            begun = perf_counter()
            shown = Fraction(snapshot.pts) * snapshot.time_base - info.start_time
            looks = stage.looks_at(snapshot.frame_index, shown, 0)
            stage.draw(looks, Posed(snapshot, None, None, {}, None, None))
            times.append(perf_counter() - begun)
    return float(np.mean(times[3:]))


def main() -> None:
    """Print both, and how much more the curves take."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--track", type=Path, required=True, help="a track of the sample clip")
    given = parser.parse_args()
    styles = tuple(parse_member("--style", text, STYLES) for text in STACK)
    with tempfile.TemporaryDirectory() as folder:
        show = Path(folder) / "show.toml"
        show.write_text(CURVES)
        # opacities below 1 as the curves have them: the same kernels are compared
        plain = tuple(replace(s, opacity=min(s.opacity, 0.9)) for s in styles[1:])
        still = Job(SolveOptions(CLIP), Look(styles=(styles[0], *plain)))
        moved = with_timeline(replace(still, look=replace(still.look, timeline=str(show))))
        both = [
            (seconds(still, given.track), seconds(moved, given.track))
            for _ in range(1 + given.rounds)
        ]
    steady, curved = (statistics.median(pair[i] for pair in both[1:]) for i in (0, 1))
    print(f"constant {1e3 * steady:.2f} ms, 20 curves {1e3 * curved:.2f} ms a frame: ", end="")
    print(f"{100 * (curved / steady - 1):+.1f} %")


if __name__ == "__main__":
    main()
