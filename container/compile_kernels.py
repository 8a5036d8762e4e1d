"""Compile the kernels that jobs need, ahead of time: what runs later finds them and starts at once.

    WARP_CACHE_PATH=FOLDER python container/compile_kernels.py

Kernels are kept in the folder that the variable names, else in Warp's own. They are those of the
processor on which this runs; a card compiles its own when it is first used.
"""

import sys
import tempfile
from pathlib import Path
from time import perf_counter

import numpy as np

import trimotion
from stages.media.writing.still_writer import encode_still
from stages.moves import MOVES
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.styles import STYLES

SIZE = (96, 64)
"""Of the pictures that are solved [px]: kernels do not depend on it."""
QUICK = {"triangles": 60, "iterations": 6}
"""Options with which a picture takes no time."""
FOLLOWED = {**QUICK, "frame_iterations": 6}
"""And later ones."""


def pictures(count: int) -> list[np.ndarray]:
    """A slope and a square that moves over it."""
    width, height = SIZE
    slope = np.linspace(0, 255, width * height * 3).reshape(height, width, 3).astype(np.uint8)
    frames = [slope.copy() for _ in range(count)]
    for number, frame in enumerate(frames):
        frame[20:40, 10 + 4 * number : 40 + 4 * number] = (220, 60, 30)
    return frames


def solve_all(frames: list[np.ndarray]) -> list[trimotion.Triangulation]:
    """Solve in every colour model, with pixels that count more and without; a picture of each."""
    weights = np.full(frames[0].shape[:2], 255, np.uint8)
    weights[:, ::2] = 60
    found = []
    for color in COLOR_MODELS:
        trimotion.triangulate(frames[0], color=color, weights=weights, **QUICK)
        trimotion.triangulate(frames[0], color=color, space="luma", **QUICK)
        found.append(trimotion.triangulate(frames[0], color=color, **QUICK))
        with trimotion.Animator(SIZE, color=color, **FOLLOWED) as animator:
            for frame in frames:
                animator.feed(frame)
            animator.finish()
    return found


def draw_all(solved: list[trimotion.Triangulation]) -> None:
    """Draw every style."""
    for one in solved:
        for style in STYLES:
            if style != "texture":  # which wants a picture, and has kernels of its own in a job
                one.draw([style], scale=2)


def animate_all(frames: list[np.ndarray], folder: Path) -> None:
    """Make films as commands do, with triangles that fade in over others."""
    for number, frame in enumerate(frames):
        (folder / f"in_{number:04d}.png").write_bytes(encode_still(frame, "png", None))
    source = folder / "in_####.png"
    for style in ("flat", "gradient", "hatching"):
        trimotion.animate(source, folder / f"{style}.mp4", styles=[style], blend=2, **FOLLOWED)
    trimotion.animate(source, folder / "moved.mp4", moves=list(MOVES), **FOLLOWED)


def main() -> int:
    """Compile, and tell how long it took."""
    begun = perf_counter()
    frames = pictures(3)
    with tempfile.TemporaryDirectory() as folder:
        draw_all(solve_all(frames))
        animate_all(frames, Path(folder))
    print(f"kernels compiled in {perf_counter() - begun:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
