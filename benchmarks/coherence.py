"""Measure coherence over time: tracked meshes against a plain warm start and independent frames.

    python benchmarks/coherence.py [FOLDER | CLIP ...] [--frames A-B] [--size WxH] [--write]

Every clip is reduced to one size and converted three ways, all drawn without loss:

    tracked       the defaults
    warm start    --flow none: each frame starts from the mesh of the one before, where it was
    independent   --independent: each frame is triangulated from scratch

`--write` puts the table and a plot for each clip into docs/results/coherence.md and its folder.
A clip may name its own frames: CLIP:A-B. Means over the frames of a clip.
"""

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import matplotlib as mpl
from timing import program, table

from pipeline.compare.measure import measure
from pipeline.compare.report import FrameFigures, Report
from pipeline.loop.animate import animate
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from stages.flows.none import NoFlow
from stages.look.output_size import parse_size
from stages.media import FrameRange, open_decoder
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "docs" / "results"
ENDINGS = frozenset({".mp4", ".mov", ".mkv", ".webm", ".avi", ".mpg", ".gif"})
WAYS: dict[str, Callable[[SolveOptions], SolveOptions]] = {
    "tracked": lambda options: options,
    "warm start": lambda options: replace(options, flow=NoFlow()),
    "independent": lambda options: replace(options, independent=True),
}
"""How a clip is converted, by name."""
HEADS = (
    "clip",
    "way",
    "E_warp lag 1 [1e-3]",
    "lag 4 [1e-3]",
    "tOF [px]",
    "rmse",
    "births",
    "deaths",
    "flips",
    "life [frames]",
    "jitter [px]",
    "pops [1e-3]",
    "inverted",
)


LEGEND = """\
- **tracked**: the defaults. **warm start**: `--flow none`, each frame starts from the mesh of the
  one before, where it was. **independent**: `--independent`, each frame from scratch.
- **E_warp**: mean squared difference between a picture and a later one (1 or 4 frames) brought
  back along the motion of the source, over the pixels that both show; colours in [0, 1]. What the
  source itself has is noise, light and errors of the estimated motion.
- **tOF**: mean distance between the motion vectors (Farnebäck) of output and source.
- **births, deaths, flips**: vertices that come and go and edges that are exchanged, per step.
- **life**: median number of frames that a triangle lives; the clip's ends cut lives short.
- **jitter**: mean second difference of the vertices' paths, the source's motion taken off.
- **pops**: area times squared change of colour of the triangles that come and go, per pixel of
  the picture: in the unit of E_warp.
- **inverted**: triangles without a positive area, in all frames together.

Independent frames share no vertex: all go and come in each step, none flips, and there are no
paths. Where triangles can show a picture almost exactly, as with flat shapes, even these are calm:
a good fit is coherent by itself.

`benchmarks/coherence.py --write` makes this page; `trimotion measure SOURCE OUTPUT --track
JOB.mtrk` prints the same for any clip.
"""


@dataclass(frozen=True)
class Panel:
    """One metric in the plot."""

    title: str
    """What it is, with its unit."""
    of_frame: Callable[[FrameFigures], float | None]
    """Its value for a frame."""
    is_wide: bool = False
    """Whether the ways differ by orders of magnitude."""


PANELS = (
    Panel("E_warp, lag 1 [1e-3]", lambda f: _small(f.coherence.warp_errors[1])),
    Panel("E_warp, lag 4 [1e-3]", lambda f: _small(f.coherence.warp_errors[4])),
    Panel("tOF [px]", lambda f: f.coherence.motion_difference),
    Panel("rmse [code values]", lambda f: f.rmse),
    Panel(
        "births + deaths", lambda f: _sum(f.mesh.births, f.mesh.deaths) if f.mesh else None, True
    ),
    Panel("flips", lambda f: f.mesh.flips if f.mesh else None),
    Panel("jitter [px]", lambda f: f.mesh.jitter if f.mesh else None),
    Panel("pop energy [1e-3]", lambda f: _small(f.mesh.pop_energy) if f.mesh else None),
)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = program(__doc__)
    parser.add_argument("clips", nargs="*", default=[str(ROOT / "sample_videos")])
    parser.add_argument("--frames", default="0-21", metavar="A-B")
    parser.add_argument("--size", type=parse_size, default=(640, 360), metavar="WxH")
    parser.add_argument("--triangles", type=int, default=1000)
    parser.add_argument("--write", action="store_true", help="write docs/results/coherence*")
    return parser.parse_args()


def clips_of(names: list[str], frames: str) -> Iterator[tuple[Path, FrameRange]]:
    """Clips and their frames; a folder stands for the clips in it."""
    for name in names:
        path = Path(name)
        if path.is_dir():
            found = sorted(entry for entry in path.iterdir() if entry.suffix.lower() in ENDINGS)
            yield from ((entry, FrameRange.parse(frames)) for entry in found)
        elif path.exists():
            yield path, FrameRange.parse(frames)
        else:
            clip, _, own = name.rpartition(":")
            yield Path(clip), FrameRange.parse(own)


def reduced(clip: Path, frames: FrameRange, wanted: tuple[int, int], folder: Path) -> Path:
    """Write the frames of a clip as stills of one size, turned if the clip stands upright."""
    pattern = folder / "source_####.png"
    with open_decoder(clip, frames) as decoder:
        upright = decoder.info.height > decoder.info.width
        target = wanted[::-1] if upright else wanted
        for number, frame in enumerate(decoder):
            still = cv2.resize(frame.pixels, target, interpolation=cv2.INTER_AREA)
            name = str(pattern).replace("####", f"{number:04d}")
            cv2.imwrite(name, cv2.cvtColor(still, cv2.COLOR_RGB2BGR))
    return pattern


def convert_and_measure(source: Path, way: str, triangles: int, folder: Path) -> Report:
    """Convert a clip one way and compare the result with it."""
    name = way.replace(" ", "_")
    wanted = TriangulateOptions(refine=RefineOptions(triangles=triangles))
    track = folder / f"{name}.mtrk"
    output = folder / f"{name}_####.png"
    options = WAYS[way](SolveOptions(source, triangulate=wanted))
    animate(Job(options, output=Output(output, track=track)), Progress())
    return measure(source, output, FrameRange(), track)


def row(clip: str, way: str, report: Report) -> tuple[str, ...]:
    """What the table says about one conversion."""
    coherence, track = report.coherence, report.track
    assert track is not None
    return (
        clip,
        way,
        *(_figure(_small(coherence.warp_errors[lag])) for lag in (1, 4)),
        _figure(coherence.motion_difference),
        _figure(report.rmse, 2),
        *(_figure(value, 1) for value in (track.births, track.deaths, track.flips)),
        _figure(track.median_life, 1),
        _figure(track.jitter),
        _figure(_small(track.pop_energy)),
        str(track.inverted),
    )


def source_row(clip: str, report: Report) -> tuple[str, ...]:
    """What the table says about the source itself."""
    errors = (_figure(_small(report.coherence.source_warp_errors[lag])) for lag in (1, 4))
    return clip, "source itself", *errors, "0.000", "0.00", *[""] * 7


def plot(clip: str, reports: dict[str, Report], path: Path) -> None:
    """Draw every metric over the frames, a line for each way."""
    mpl.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(2, 4, figsize=(15, 6.4), sharex=True)
    for panel, axes in zip(PANELS, panels.flat, strict=True):
        for way, report in reports.items():
            values = [panel.of_frame(frame) for frame in report.frames]
            known = [
                (f.frame, v) for f, v in zip(report.frames, values, strict=True) if v is not None
            ]
            axes.plot(*zip(*known, strict=True) if known else ((), ()), ".-", label=way)
        axes.set_title(panel.title, fontsize=10)
        if panel.is_wide:
            axes.set_yscale("symlog", linthresh=10)
        axes.set_ylim(bottom=0)
        axes.grid(True, alpha=0.25)
    panels[0, 0].legend(fontsize=8)
    figure.supxlabel("frame", fontsize=9)
    figure.suptitle(clip, fontsize=10)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80)
    pyplot.close(figure)


def page(text: str, clips: list[str]) -> str:
    """The results as Markdown."""
    pictures = "\n\n".join(f"![coherence of {clip}](coherence/{clip}.png)" for clip in clips)
    return f"# Coherence over time\n\n{text}\n\n{LEGEND}\n{pictures}\n"


def main() -> None:
    """Print the table; write what was asked for."""
    options = parse()
    rows, names = [], []
    for clip, frames in clips_of(options.clips, options.frames):
        with TemporaryDirectory() as name:
            folder = Path(name)
            source = reduced(clip, frames, options.size, folder)
            reports = {
                way: convert_and_measure(source, way, options.triangles, folder) for way in WAYS
            }
        title = f"{clip.stem} {frames}"
        rows.append(source_row(title, next(iter(reports.values()))))
        rows.extend(row(title, way, report) for way, report in reports.items())
        names.append(clip.stem)
        print(table(HEADS, rows[-len(reports) - 1 :]), flush=True)
        if options.write:
            plot(title, reports, RESULTS / "coherence" / f"{clip.stem}.png")
    facts = "{}x{}, {:,} triangles".format(*options.size, options.triangles)
    text = f"{facts}.\n\n{table(HEADS, rows)}"
    print(f"\n{text}")
    if options.write:
        (RESULTS / "coherence.md").write_text(page(text, names), encoding="utf-8")


def _small(value: float | None) -> float | None:
    """A squared error in thousandths."""
    return None if value is None else 1e3 * value


def _sum(*values: float | None) -> float | None:
    return None if None in values else sum(value for value in values if value is not None)


def _figure(value: float | None, digits: int = 3) -> str:
    return "" if value is None else f"{value:.{digits}f}"


if __name__ == "__main__":
    main()
