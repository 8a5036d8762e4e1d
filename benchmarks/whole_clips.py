"""Measure coherence over whole clips, at their own size, on pairs of frames spread over them.

    python benchmarks/whole_clips.py CLIP ... [--every N] [--triangles N] [--keep FOLDER]
                                     [--focus none|auto] [--option=--NAME=VALUE ...]

A clip is converted from its first frame to its last, with the defaults and what `--option` says.
Of every Nth frame and the one after it the drawn pictures are compared with those of independent
frames (`--independent`), which are made of these pairs alone. Both have the same `--focus`, for
one gives up error of the whole picture for that of faces, whether frames are followed or not:

    E_warp    mean of the pairs [1e-3], and that of the independent frames divided by it
    rmse      mean over the frames of the pairs, beside that of the independent frames

`--keep` has the independent pictures stay in a folder, and takes those that lie there: they are by
far the most work, and stay those of the version that made them. Another version can be measured
with PYTHONPATH if it has the modules that are imported here; 0.1.0 lacks `SourceMotion`.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from timing import program, table

from pipeline.cli import main as trimotion
from stages.media import FrameRange, open_decoder
from stages.metrics.motion import SourceMotion
from stages.metrics.warp_error import warp_error

FOCUS = "--focus"
HEADS = ("clip", "pairs", "E_warp [1e-3]", "independent", "calmer", "rmse", "beside independent")


@dataclass(frozen=True)
class Pair:
    """Two consecutive frames of a clip."""

    number: int
    """Of the earlier one."""
    earlier: np.ndarray
    """[H, W, 3] uint8."""
    later: np.ndarray
    """[H, W, 3] uint8."""


@dataclass(frozen=True)
class Figures:
    """What was measured of drawn pairs."""

    warp: float
    """E_warp, mean of the pairs [1e-3]."""
    rmse: float
    """Root mean square error, mean over their frames [code values]."""


def pairs_of(clip: Path, every: int) -> list[Pair]:
    """Every so many frames one and the next, the first pair half that far from the beginning.

    Args:
        clip: The source.
        every: Frames from one pair to the next.
    """
    found = []
    held: np.ndarray | None = None
    with open_decoder(clip, FrameRange()) as decoder:
        for number, frame in enumerate(decoder):
            if held is not None:
                found.append(Pair(number - 1, held, frame.pixels))
            held = frame.pixels if number % every == every // 2 else None
    return found


def convert(clip: Path, output: Path, *options: str) -> None:
    """Convert a clip, or a part of it, into stills with the numbers of its frames.

    Raises:
        RuntimeError: If that failed.
    """
    output.parent.mkdir(parents=True, exist_ok=True)
    if trimotion(["animate", str(clip), "-o", str(output), "--quiet", "--overwrite", *options]):
        raise RuntimeError(f"{clip.name}: could not be converted")


def read(pattern: Path, number: int) -> np.ndarray:
    """A still of a pattern, [H, W, 3] uint8 in RGB.

    Raises:
        FileNotFoundError: If there is none.
    """
    name = pattern.with_name(pattern.name.replace("######", f"{number:06d}"))
    if not name.exists():
        raise FileNotFoundError(name)
    picture: np.ndarray = cv2.imread(str(name))[..., ::-1]
    return picture


def measured(pairs: list[Pair], pattern: Path, motions: list[SourceMotion]) -> Figures:
    """Compare drawn pairs with the source."""
    warps, errors = [], []
    for pair, motion in zip(pairs, motions, strict=True):
        drawn = [read(pattern, pair.number + step) for step in (0, 1)]
        warp = warp_error(*drawn, motion)
        if warp is not None:
            warps.append(warp)
        for shown, source in zip(drawn, (pair.earlier, pair.later), strict=True):
            errors.append(np.sqrt(np.square(shown - source.astype(float)).mean()))
    return Figures(1e3 * float(np.mean(warps)), float(np.mean(errors)))


def independent(clip: Path, pairs: list[Pair], pattern: Path, *options: str) -> None:
    """Make those independent pictures of pairs that are not there yet."""
    for pair in pairs:
        try:
            read(pattern, pair.number + 1)
        except FileNotFoundError:
            span = f"--frames={pair.number}-{pair.number + 1}"
            convert(clip, pattern, "--independent", "--cuts=none", span, *options)


def row(clip: Path, options: argparse.Namespace, folder: Path) -> tuple[str, ...]:
    """What the table says about a clip."""
    pairs = pairs_of(clip, options.every)
    motions = [SourceMotion.between(pair.earlier, pair.later) for pair in pairs]
    name = f"{clip.stem}_{options.triangles}" + ("" if options.focus == "none" else "_focus")
    kept = (options.keep or folder) / name / "frame_######.png"
    shared = (f"--triangles={options.triangles}", f"{FOCUS}={options.focus}")
    independent(clip, pairs, kept, *shared)
    drawn = folder / clip.stem / "frame_######.png"
    convert(clip, drawn, *shared, *options.option)
    own, other = measured(pairs, drawn, motions), measured(pairs, kept, motions)
    return (
        clip.name,
        str(len(pairs)),
        f"{own.warp:.4f}",
        f"{other.warp:.4f}",
        f"1/{other.warp / own.warp:.2f}",
        f"{own.rmse:.3f}",
        f"{100 * (own.rmse / other.rmse - 1):+.2f} %",
    )


def main() -> None:
    """Print the table."""
    parser = program(__doc__)
    parser.add_argument("clips", nargs="+", type=Path)
    parser.add_argument("--every", type=int, default=14, help="frames from one pair to the next")
    parser.add_argument("--triangles", type=int, default=1500)
    parser.add_argument("--keep", type=Path, help="folder of the independent pictures")
    parser.add_argument(FOCUS, choices=("none", "auto"), default="none", help="of both sides")
    parser.add_argument("--option", action="append", default=[], help="for the conversion")
    options = parser.parse_args()
    if any(option.startswith(FOCUS) for option in options.option):
        parser.error(f"--option={FOCUS}=...: say {FOCUS} itself, which both sides get")
    rows = []
    for clip in options.clips:
        with TemporaryDirectory() as name:
            rows.append(row(clip, options, Path(name)))
        print(table(HEADS, rows[-1:]), flush=True)
    print(f"\n{table(HEADS, rows)}")


if __name__ == "__main__":
    main()
