"""A program as users write them: it uses every public name, and `mypy --strict` reads it."""

from itertools import pairwise
from pathlib import Path

import numpy as np

import trimotion
from trimotion import MediaError, OutputError, TrackError, TrimotionError

FINE: trimotion.PictureKeywords = {"triangles": 60, "color": "linear"}
QUICK: trimotion.AnimatorKeywords = {
    "triangles": 60,
    "iterations": 8,
    "frame_iterations": 4,
    "cuts": "none",
}
SOLVED: trimotion.SolveKeywords = {"triangles": 60, "frames": "0-2", "overwrite": True}
DRAWN: trimotion.RenderKeywords = {"styles": ["flat", "edges:width=1"], "scale": 0.5}
WHOLE: trimotion.AnimateKeywords = {"frames": "0-2", "size": (48, 32), "audio": False}


def tell(done: trimotion.FrameDone) -> None:
    """Print a line for every frame."""
    print(f"{done.done}/{done.total}: {done.triangles} triangles, rmse {done.rmse:.1f}")


def convert(clip: Path, folder: Path) -> float:
    """Convert a clip at once and in two steps; gives the error of the second."""
    first: trimotion.Result = trimotion.animate(clip, folder / "a.mkv", progress=tell, **WHOLE)
    print(first.output, first.frames, first.seconds, first.mean_rmse, *first.notes, *first.warnings)
    trimotion.solve(str(clip), str(folder / "a.mtrk"), **SOLVED)
    trimotion.render(folder / "a.mtrk", folder / "b.mkv", progress=None, **DRAWN)
    report: trimotion.Report = trimotion.measure(
        clip, folder / "b.mkv", track=folder / "a.mtrk", frames="0-2"
    )
    return report.rmse


def look(path: Path) -> np.ndarray:
    """Look into a track; gives a picture of its last frame."""
    with trimotion.open_track(path) as track:
        opened: trimotion.Track = track
        print(opened.path, opened.source, opened.size, opened.shots, opened.finished)
        print(len(opened), opened.frames, opened.program, opened.options["triangles"])
        total = sum(len(one.triangles) for one in opened)
        last: trimotion.Triangulation = opened[opened.frames[-1]]
        print(total, last.frame, last.shot, last.time, last.size, last.colors[0])
        print(last.save(path.with_suffix(".svg"), ["flat", "edges"], svg_precision=1))
        return last.draw(["flat", "edges"], scale=2)


def follow(frames: list[np.ndarray]) -> list[np.ndarray]:
    """Follow frames that come one by one; gives how far vertices have moved [px]."""
    found: list[trimotion.Triangulation] = []
    with trimotion.Animator((96, 64), **QUICK) as animator:
        for number, pixels in enumerate(frames):
            found += animator.feed(pixels, new_shot=number == 0)
        print(len(animator.finish()))
    moved = []
    for before, after in pairwise(found):
        _, one, other = np.intersect1d(before.vertex_ids, after.vertex_ids, return_indices=True)
        moved.append(after.vertices[other] - before.vertices[one])
    return moved


def mistakes(folder: Path) -> list[str]:
    """Make one of each kind; gives what they say."""
    said = []
    for triangles, source, output in (
        (0, "in.mp4", "out.mp4"),
        (9, str(folder / "missing.mp4"), "out.mp4"),
        (9, str(folder / "a.mkv"), str(folder / "nowhere" / "out.mp4")),
    ):
        try:
            trimotion.animate(source, output, triangles=triangles)
        except trimotion.OptionError as error:
            said.append(f"option: {error}")
        except OutputError as error:
            said.append(f"output: {error.problem}; {error.remedy}")
        except MediaError as error:
            said.append(f"media: {error}")
    try:
        trimotion.open_track(folder / "a.mkv")
    except TrackError as error:
        said.append(f"track: {error}")
    except TrimotionError as error:
        said.append(f"other: {error}")
    return said


def main(clip: Path, folder: Path) -> list[str]:
    """Do all of it."""
    print(trimotion.__version__, convert(clip, folder), look(folder / "a.mtrk").shape)
    pixels = np.zeros((64, 96, 3), np.uint8)
    pixels[20:40, 30:60] = 200
    one = trimotion.triangulate(pixels, **FINE)
    print(one.vertices.shape, one.triangle_ids[:3], one.rmse)
    print([float(np.abs(step).max()) for step in follow([pixels, np.roll(pixels, 2, axis=1)])])
    return mistakes(folder)
