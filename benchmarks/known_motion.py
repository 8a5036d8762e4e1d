"""Held vertices beside motion that is known: do they drift, and do patches that judge them?

    python -m benchmarks.known_motion [CLIP] [--flow FOLDER ...] [--triangles N] [--seed N]

A frame of Big Buck Bunny, around the face, is moved in ways that are known to the bit: shifted,
zoomed, turned, and rippled as fur is, with and without noise of its own in every frame. A folder
holds a clip with its exact flow: `frames_lossless.mp4`, `flow.npz` with an array `flow` of
[frames - 1, H, W, 2] px from each frame to the next, and `occlusions/frame_0001.png` and so on,
white where the next frame does not show a pixel.

In the middle frame vertices are put there, which the program then holds through the clip, before
and after it. Their places are compared with where the motion takes them, as long as it leaves them
in the picture and in sight. So are the chains of patches of `benchmarks.edited_clip`, in both ways:
with which of them the program agrees says nothing as long as it is not known which is right.
"""

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.linalg import norm

from benchmarks.edited_clip import AT, CLIP, FACE, NEAR, RADIUS, WAYS, chains, places_of
from pipeline.loop.animate import solve
from pipeline.options.edit_log import EditLog
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.hand.insert import Insert
from stages.media import FrameRange, open_decoder
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions

SIZE = (720, 400)
"""Width and height of the made clips [px]."""
FRAMES = 41
"""How many frames a made clip has; the middle one is edited."""
NOISE = 4.0
"""Standard deviation of the noise of a frame [code values]."""
SPOTS, EACH = 6, 20
"""Places at which vertices are put in clips with flow, and how many at each."""
MARGIN = 12.0
"""So near to the border of the picture nothing is judged [px]."""
CLOSE, UNKNOWN = 1e-3, 0.1
"""How closely it is known from where a pixel of a still came, and one of a flow at least [px]."""
Motion = Callable[[np.ndarray, int], np.ndarray]
"""Where points of the middle frame are in one so many frames later, [..., 2] px."""


@dataclass(frozen=True)
class Scene:
    """A clip of known motion."""

    name: str
    """What it is called."""
    source: Path
    """Its frames."""
    frames: int
    """How many."""
    spots: tuple[tuple[float, float], ...]
    """Where vertices are put [px]."""
    radius: float
    """How far around them [px]."""
    count: int
    """How many at each."""
    truth: Callable[[np.ndarray, range], Iterator[np.ndarray]]
    """Where points of the first of some frames are in each, [N, 2]; NaN once out of sight."""


def affine(shift: tuple[float, float], zoom: float, turn: float) -> Motion:
    """Shifted [px a frame], zoomed [1 a frame] and turned [degrees a frame] about the middle."""
    middle = np.array(SIZE) / 2

    def moved(points: np.ndarray, frames: int) -> np.ndarray:
        angle = np.radians(turn * frames)
        cos, sin = np.cos(angle), np.sin(angle)
        matrix = zoom**frames * np.array([[cos, -sin], [sin, cos]])
        return (points - middle) @ matrix.T + middle + np.array(shift) * frames

    return moved


def rippled(points: np.ndarray, frames: int) -> np.ndarray:
    """Waves that run through the picture while it moves on: every part has its own way."""
    phase = 2 * np.pi * (points / (170.0, 130.0) + frames / 17.0)
    calm = 2 * np.pi * points / (170.0, 130.0)
    waves = 5.0 * (np.sin(phase) - np.sin(calm))[..., ::-1]
    return points + waves + np.array([1.3, -0.6]) * frames


MOTIONS: dict[str, Motion] = {
    "shifted": affine((2.3, -0.9), 1.0, 0.0),
    "zoomed": affine((0.0, 0.0), 1.008, 0.0),
    "turned": affine((0.4, 0.3), 1.0, 0.6),
    "all three": affine((1.7, -0.6), 1.006, 0.5),
    "rippled": rippled,
}
"""What happens to a still."""


def drawn(still: np.ndarray, motion: Motion, frames: int) -> np.ndarray:
    """A still as it is so many frames later, [rows, columns, 3] uint8.

    Args:
        still: The picture; the middle of `SIZE` lies over its face.
        motion: How it moves.
        frames: How many.
    """
    width, height = SIZE
    places = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1) + 0.5
    found = places.copy()
    missing = np.ones(1)
    while np.abs(missing).max() > CLOSE:  # where each pixel came from
        missing = places - motion(found, frames)
        found += missing
    found += np.array(FACE) - np.array(SIZE) / 2 - 0.5
    return _looked_up(still, found, cv2.INTER_LANCZOS4, cv2.BORDER_REFLECT)


def made(clip: Path, folder: Path, name: str, noise: float) -> Scene:
    """A still that moves."""
    motion, middle = MOTIONS[name], FRAMES // 2
    with open_decoder(clip, FrameRange(AT, AT)) as decoder:
        (frame,) = decoder
    rng = np.random.default_rng(1)
    for number in range(FRAMES):
        picture = drawn(frame.pixels, motion, number - middle).astype(float)
        picture += noise * rng.standard_normal(picture.shape)
        pixels = np.clip(np.rint(picture), 0, 255).astype(np.uint8)
        cv2.imwrite(str(folder / f"{number:04d}.png"), pixels[..., ::-1])

    def truth(points: np.ndarray, frames: range) -> Iterator[np.ndarray]:
        for number in frames:
            yield motion(points, number - middle)

    at = (SIZE[0] / 2, SIZE[1] / 2)
    told = f"{name}, noise {noise:g}" if noise else name
    return Scene(told, folder / "####.png", FRAMES, (at,), RADIUS, 60, truth)


def given(folder: Path, seed: int) -> Scene:
    """A clip whose flow is known."""
    flow = np.load(folder / "flow.npz")["flow"].astype(np.float64)
    covered = [_mask(folder / "occlusions" / f"frame_{n + 1:04d}.png") for n in range(len(flow))]

    def truth(points: np.ndarray, frames: range) -> Iterator[np.ndarray]:
        at = points.copy()
        yield at
        for before, after in pairwise(frames):
            first = min(before, after)
            if after > before:
                hidden = _at(covered[first], at) > 0
                at = at + _at(flow[first], at)
            else:
                goal, at = at, at.copy()
                for _ in range(40):
                    at = goal - _at(flow[first], at)
                misses = norm(at + _at(flow[first], at) - goal, axis=1) > UNKNOWN
                hidden = misses | (_at(covered[first], at) > 0)
            at[hidden] = np.nan
            yield at

    height, width = flow.shape[1:3]
    rng = np.random.default_rng(seed)
    spots = rng.uniform((60, 60), (width - 60, height - 60), (SPOTS, 2))
    where = tuple((float(x), float(y)) for x, y in spots)
    source = folder / "frames_lossless.mp4"
    return Scene(folder.name, source, len(flow) + 1, where, 30.0, EACH, truth)


def _mask(path: Path) -> np.ndarray:
    """A mask, [rows, columns] float64, above 0 where it is white."""
    found = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if found is None:
        raise SystemExit(f"{path}: cannot be read; give a folder as described above")
    return found.astype(float)


def _at(values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Values of a field between its pixels, [N] or [N, C]; NaN where a point is none."""
    places = points - 0.5
    layers = values[..., None] if values.ndim == 2 else values
    known = np.nan_to_num(places[None], nan=-9.0)
    found = [
        _looked_up(np.ascontiguousarray(layer), known, cv2.INTER_LINEAR, cv2.BORDER_REPLICATE)[0]
        for layer in np.moveaxis(layers.astype(np.float32), -1, 0)
    ]
    taken = np.stack(found, axis=-1).astype(np.float64)
    taken[np.isnan(points[:, 0])] = np.nan
    return taken if values.ndim == 3 else taken[:, 0]


def _looked_up(picture: np.ndarray, places: np.ndarray, way: int, border: int) -> np.ndarray:
    """Values of a picture at places whose pixels' centres are whole numbers."""
    x, y = np.moveaxis(places.astype(np.float32), -1, 0)
    found: np.ndarray = cv2.remap(picture, x, y, way, borderMode=border)
    return found


def judged(scene: Scene, triangles: int, seed: int, folder: Path) -> None:
    """Solve a scene and print how far the program and both kinds of chains are from the truth."""
    wanted = TriangulateOptions(refine=RefineOptions(triangles=triangles))
    middle, last = scene.frames // 2, scene.frames - 1
    log = EditLog(
        tuple(Insert(middle, spot, scene.radius, scene.count, seed=seed) for spot in scene.spots)
    )
    options = SolveOptions(scene.source, FrameRange(0, last), triangulate=wanted, edits=log)
    track = folder / f"{scene.name}.mtrk"
    for warning in solve(options, Output(track=track), Run(), Progress()).warnings:
        print(f"{scene.name}: {warning}")
    with TrackReader(track) as reader:
        snapshot = reader.snapshot(middle)
    ids, size = snapshot.locks.vertices, (snapshot.mesh.width, snapshot.mesh.height)
    begun = places_of(track, middle, ids)
    apart: dict[str, list[np.ndarray]] = {"program": [], **{way: [] for way in WAYS}}
    agrees: dict[str, list[np.ndarray]] = {way: [] for way in WAYS}
    total = 0
    for frames in (range(middle, last + 1), range(middle, -1, -1)):
        seen = {way: dict(chains(scene.source, frames, begun, WAYS[way])) for way in WAYS}
        inside = np.ones(len(ids), dtype=bool)
        for frame, there in zip(frames, scene.truth(begun, frames), strict=True):
            with np.errstate(invalid="ignore"):
                inside &= ((there > MARGIN) & (there < np.array(size) - MARGIN)).all(axis=1)
            if frame == middle:
                continue
            total += int(inside.sum())
            held = places_of(track, frame, ids)
            apart["program"].append(norm(held - there, axis=1)[inside])
            for way, places in seen.items():
                apart[way].append(norm(places[frame] - there, axis=1)[inside])
                agrees[way].append(norm(places[frame] - held, axis=1)[inside])
    print(f"{scene.name}: {len(ids)} held vertices, {total} times in sight")
    for name, distances in apart.items():
        print(f"  {name} beside the truth: {_told(np.concatenate(distances))}")
    for way, distances in agrees.items():
        print(f"  program beside patches by {way}: {_told(np.concatenate(distances))}", flush=True)


def _told(distances: np.ndarray) -> str:
    """How many places are known, and how near they are."""
    known = distances[np.isfinite(distances)]
    if not len(known):
        return "none are known"
    near = (known <= NEAR).mean()
    middle, most = np.percentile(known, (50, 95))
    return (
        f"known {len(known) / len(distances):.1%}, of those within {NEAR} px {near:.1%}, "
        f"middle {middle:.2f} px, 95 % within {most:.2f} px"
    )


def main() -> None:
    """Run all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clip", type=Path, nargs="?", default=CLIP)
    parser.add_argument("--flow", type=Path, nargs="*", default=[], help="folders of exact flow")
    parser.add_argument("--triangles", type=int, default=700)
    parser.add_argument("--seed", type=int, default=1, help="of the edits")
    asked = parser.parse_args()
    with TemporaryDirectory() as name:
        folder = Path(name)
        for number, motion in enumerate(MOTIONS):
            for noise in (0.0, NOISE):
                own = folder / f"{number}_{noise:g}"
                own.mkdir()
                judged(made(asked.clip, own, motion, noise), asked.triangles, asked.seed, own)
        for place in asked.flow:
            judged(given(place, asked.seed), asked.triangles, asked.seed, folder)


if __name__ == "__main__":
    main()
