"""How large the step over the seam of a loop is, beside those between its other frames.

    python benchmarks/loop_seam.py FILM ...

FILM is a film that was made with `--loop`. A step is the root mean square of what changes between
two frames [code values]; the seam leads from the last frame to the first one.
"""

import argparse
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from contact_sheet import read_frames


def steps_of(path: Path) -> tuple[np.ndarray, float]:
    """Steps between the frames of a film [code values], and that over its seam."""
    frames = [pixels.astype(np.float32) for _, pixels in read_frames(path)]
    changes = [rms(after - before) for before, after in pairwise(frames)]
    return np.array(changes), rms(frames[0] - frames[-1])


def rms(change: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(change**2)))


def main() -> int:
    """Print a line a film."""
    parser = argparse.ArgumentParser(description="Measure the seams of loops.")
    parser.add_argument("films", nargs="+", type=Path, metavar="FILM")
    print("film                     frames    seam  before   after  median largest  seam/median")
    for path in parser.parse_args().films:
        changes, seam = steps_of(path)
        median = float(np.median(changes))
        print(
            f"{path.name:24} {len(changes) + 1:6d} {seam:7.2f} {changes[-1]:7.2f} "
            f"{changes[0]:7.2f} {median:7.2f} {changes.max():7.2f} {seam / median:8.2f}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
