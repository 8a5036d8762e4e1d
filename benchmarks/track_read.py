"""What a random frame of a track costs to read.

    python benchmarks/track_read.py TRACK [COUNT]

Frames are read in an order that a seed gives, after five that warm up, as a command reads them.
Prints CPU time a frame [ms] and the bytes that one takes in the file.
"""

import random
import sys
import time
from pathlib import Path

import numpy as np

from pipeline.kept_memory import keep_memory
from pipeline.track.reader import TrackReader


def main() -> int:
    """Read, and tell."""
    path, count = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 400
    keep_memory()
    with TrackReader(path) as track:
        frames = [row.frame for row in track.rows]
        order = random.Random(1).choices(frames, k=count + 5)
        spent = []
        for frame in order:
            begun = time.process_time()
            track.snapshot(frame)
            spent.append(1e3 * (time.process_time() - begun))
    spent = spent[5:]
    print(
        f"{len(frames)} frames, {path.stat().st_size / len(frames) / 1e3:.0f} KB each; CPU time "
        f"of a random one: mean {np.mean(spent):.2f} ms, 95 % below {np.quantile(spent, 0.95):.2f}"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
