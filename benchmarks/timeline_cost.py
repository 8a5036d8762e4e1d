"""What twenty curves cost: every frame drawn by them, and again with the same values held.

Run it in the root of the repository: python benchmarks/timeline_cost.py [--rounds 5]
"""

import argparse
import tempfile
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


def seconds(job: Job, track: Path) -> np.ndarray:
    """How long frames take to be drawn, without encoding [s]: constant and by curves, [2].

    Every frame is drawn by its curves and at once again with the same values held, so that both
    draw the same pixels and differ in what the curves take alone.
    """
    info = probe(CLIP)
    framing = job.look.framing_for((info.width, info.height), info.sample_aspect)
    times = []
    with TrackReader(track) as reader, Device("auto", 0) as device:
        stage = open_stage(device, job, info, framing)
        for row in reader.rows:
            snapshot = reader.snapshot(row.frame)
            view = Posed(snapshot, None, None, {}, None, None, {})
            begun = perf_counter()
            shown = Fraction(snapshot.pts) * snapshot.time_base - info.start_time
            looks = stage.looks_at(snapshot.frame_index, shown, 0)
            stage.draw(looks, view)
            curved = perf_counter()
            stage.draw(looks, view)
            times.append((perf_counter() - curved, curved - begun))
    return np.median(times[3:], axis=0)


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
        job = with_timeline(Job(SolveOptions(CLIP), Look(styles=styles, timeline=str(show))))
        both = [seconds(job, given.track) for _ in range(given.rounds)]
    steady, curved = np.median(both, axis=0)
    print(f"constant {1e3 * steady:.2f} ms, 20 curves {1e3 * curved:.2f} ms a frame: ", end="")
    print(f"{100 * (curved / steady - 1):+.1f} %")


if __name__ == "__main__":
    main()
