"""Measure what following does where the picture boils: clips that are half calm and half not.

    python benchmarks/boiling.py [KIND ...] [--frames N] [--triangles N] [--keep FOLDER]

The left half of every clip is a photograph, which stands still or pans; the right half boils:

    foam       soft bubbles that are born and burst within a few frames
    fire       noise that rises, turns over and glows
    confetti   bright snippets that tumble down
    grain      a photograph under film grain
    water      light that dances on the bottom of a pool

For either half the error beside that of independent frames, and how many times calmer it is than
these: the bars are 4 % in what boils and 6 times in what is calm. `--keep` writes the source, the
independent and the followed frames as stills.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from timing import DEFAULT_PICTURE, program, table

from stages.flows.dis import Dis
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.frame import Frame
from stages.layouts.importance import Importance
from stages.metrics.motion import SourceMotion
from stages.metrics.warp import warped
from stages.motion.advect import advect
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from warp_kernels.device.device import Device
from warp_kernels.styles.flat import Flat

WIDTH, HEIGHT = 320, 360
"""Size of a half [px]."""
SEAM = 4
"""Pixels this close to the other half count for neither [px]."""
SETTLED = 3
"""Frames at the beginning that are not measured: the first one is that of independent frames."""
PAN = np.array([1.3, 0.4])
"""Motion of a photograph that pans [px a frame]."""
HEADS = ("boils", "calm half", "rmse there", "of it calm", "times calmer there", "of it calm")

Half = Callable[[int, np.random.Generator], list[np.ndarray]]
"""Makes as many pictures of a half, [HEIGHT, WIDTH, 3] uint8."""


def photograph(count: int, *, pan: np.ndarray, right: bool = False) -> list[np.ndarray]:
    """Pictures of the portrait, one of its halves, which moves by so much a frame [px]."""
    whole = cv2.imread(str(DEFAULT_PICTURE))[..., ::-1]
    # what is as fine as a pixel would look different at every fraction of one
    whole = cv2.GaussianBlur(whole, (0, 0), 0.8)
    corner = np.array([0.3 if right else 0.1, 0.1]) * whole.shape[1::-1]
    found = []
    for number in range(count):
        x, y = corner + pan * number
        shift = np.array([[1.0, 0.0, -x], [0.0, 1.0, -y]])
        found.append(cv2.warpAffine(whole, shift, (WIDTH, HEIGHT), flags=cv2.INTER_CUBIC))
    return found


def foam(count: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Soft bubbles, a thousand at a time, that live for four frames."""
    births = rng.uniform(-4, count, 300 * (count + 4))
    places = rng.uniform(0, 1, (len(births), 2)) * (WIDTH, HEIGHT)
    sizes = rng.gamma(3.0, 2.5, len(births)) + 2
    lights = rng.normal(0, 70, len(births))
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    found = []
    for i in range(count):
        light = 120 + 40 * np.sin(x / 60 + 0.1 * i) * np.cos(y / 50)
        for n in np.flatnonzero(np.abs(births + 2 - i) < 2):
            grown = np.sin(np.pi * (i - births[n]) / 4)
            _add_blob(light, places[n], sizes[n], lights[n] * grown)
        found.append(_bytes(light[..., None] * (0.85, 1.0, 1.05)))
    return found


def _add_blob(light: np.ndarray, place: np.ndarray, size: float, value: float) -> None:
    reach = int(2.5 * size) + 1
    x0, y0 = (max(0, int(c) - reach) for c in place)
    part = light[y0 : int(place[1]) + reach, x0 : int(place[0]) + reach]
    y, x = np.mgrid[: part.shape[0], : part.shape[1]]
    squares = (x + x0 - place[0]) ** 2 + (y + y0 - place[1]) ** 2
    part += value * np.exp(-squares / size**2)


def fire(count: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Three octaves of noise, the finer the faster they rise and turn over."""
    height = np.linspace(1.15, 0.0, HEIGHT)[::-1, None]
    total = np.zeros((count, HEIGHT, WIDTH))
    for size, speed, life in ((40, 6.0, 6.0), (20, 8.0, 4.0), (9, 10.0, 2.5)):
        rows, columns = HEIGHT // size + 4, WIDTH // size + 4
        layers = rng.normal(0, 1, (int(count / life) + 2, rows, columns)).astype(np.float32)
        for i in range(count):
            at, share = int(i / life), i / life % 1
            noise = layers[at] * np.cos(share * np.pi / 2) + layers[at + 1] * np.sin(
                share * np.pi / 2
            )
            full = cv2.resize(noise, (columns * size, rows * size), interpolation=cv2.INTER_CUBIC)
            rolled = np.roll(full, -int(speed * i), axis=0)
            total[i] += rolled[:HEIGHT, :WIDTH] * size**0.5 / 7
    glow = np.clip(height * 1.3 + 0.35 * total - 0.25, 0, 1.4)
    return [_bytes(255 * np.stack([1.6 * g, 1.2 * g**2, g**4], axis=2)) for g in glow]


def confetti(count: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Five hundred snippets of paper that tumble and fall by 4 to 14 px a frame."""
    number = 500
    places = rng.uniform(0, 1, (number, 2)) * (WIDTH, HEIGHT + 40)
    speeds = np.stack([rng.normal(0, 3, number), rng.uniform(4, 14, number)], axis=1)
    turns, phases = rng.normal(0, 0.6, (2, number)), rng.uniform(0, 2 * np.pi, (2, number))
    colors = rng.integers(40, 256, (number, 3))
    found = []
    for i in range(count):
        picture = np.full((HEIGHT, WIDTH, 3), (30, 34, 48), np.uint8)
        angle, tilt = phases + turns * i
        across = 6 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        along = 9 * np.cos(tilt)[:, None] * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
        centres = (places + speeds * i) % (WIDTH, HEIGHT + 40) - (0, 20)
        for centre, a, b, color in zip(centres, across, along, colors, strict=True):
            corners = np.array([centre + a + b, centre + a - b, centre - a - b, centre - a + b])
            cv2.fillConvexPoly(
                picture, np.rint(16 * corners).astype(np.int32), color.tolist(), cv2.LINE_AA, 4
            )
        found.append(picture)
    return found


def grain(count: int, rng: np.random.Generator) -> list[np.ndarray]:
    """The other half of the portrait, still, under grain of 1.5 px that is new in every frame."""
    found = []
    for picture in photograph(count, pan=np.zeros(2), right=True):
        rough = cv2.GaussianBlur(rng.normal(0, 60, picture.shape[:2]), (0, 0), 0.8)
        found.append(_bytes(picture + rough[..., None]))
    return found


def water(count: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Caustics: forty waves in all directions, and bright lines where their sum is flat."""
    angles, lengths = rng.uniform(0, 2 * np.pi, 40), rng.uniform(18, 60, 40)
    phases = rng.uniform(0, 2 * np.pi, 40)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    found = []
    for i in range(count):
        height = np.zeros((HEIGHT, WIDTH))
        for angle, length, phase in zip(angles, lengths, phases, strict=True):
            along = x * np.cos(angle) + y * np.sin(angle)
            height += np.sin(2 * np.pi * along / length + phase + 5.0 * i / length**0.5)
        light = np.exp(-np.abs(height) / 1.5)
        found.append(_bytes(light[..., None] * (110, 140, 110) + (20, 90, 120)))
    return found


KINDS: dict[str, Half] = {
    "foam": foam,
    "fire": fire,
    "confetti": confetti,
    "grain": grain,
    "water": water,
}


def _bytes(values: np.ndarray) -> np.ndarray:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def clip(kind: str, count: int, *, pans: bool) -> list[np.ndarray]:
    """Frames of a clip, the photograph on the left, [HEIGHT, 2 WIDTH, 3] uint8."""
    calm = photograph(count, pan=PAN if pans else np.zeros(2))
    wild = KINDS[kind](count, np.random.default_rng(7))
    return [np.concatenate(pair, axis=1) for pair in zip(calm, wild, strict=True)]


def halves() -> tuple[np.ndarray, np.ndarray]:
    """Which pixels boil, and which are calm, [HEIGHT, 2 WIDTH] bool each."""
    columns = np.arange(2 * WIDTH)
    wild, calm = columns >= WIDTH + SEAM, columns < WIDTH - SEAM
    return np.tile(wild, (HEIGHT, 1)), np.tile(calm, (HEIGHT, 1))


@dataclass(frozen=True, eq=False)
class Shown:
    """What a clip became."""

    snapshots: list[Snapshot]
    """Of every frame."""
    pictures: list[np.ndarray]
    """As drawn, [H, W, 3] uint8."""


class Solver:
    """Converts clips of one size in this process, followed or not."""

    def __init__(self, size: tuple[int, int], triangles: int) -> None:
        device = Device("cpu")
        wanted = TriangulateOptions(refine=RefineOptions(triangles=triangles))
        self._triangulator = Triangulator(device, size, wanted)
        self._renderer = Renderer(device, size, size, (Flat(),))

    def _first(self, frame: Frame) -> Snapshot:
        return self._triangulator.first(
            frame, Importance(), np.random.default_rng([0, frame.index])
        )

    def independent(self, pixels: list[np.ndarray]) -> Shown:
        """Each frame from scratch."""
        return self._shown([self._first(frame) for frame in _frames(pixels)])

    def followed(self, pixels: list[np.ndarray]) -> Shown:
        """Each frame from the one before."""
        found: list[Snapshot] = []
        views = [View(picture) for picture in pixels]
        for frame in _frames(pixels):
            if not found:
                found.append(self._first(frame))
                continue
            passage = Passage.between(Dis(), views[frame.index - 1], views[frame.index])
            found.append(self._triangulator.next(frame, advect(found[-1].mesh, passage), found[-1]))
        return self._shown(found)

    def _shown(self, snapshots: list[Snapshot]) -> Shown:
        return Shown(snapshots, [self._renderer.render(s)[..., :3] for s in snapshots])


def _frames(pixels: list[np.ndarray]) -> list[Frame]:
    return [Frame(i, i, Fraction(1, 25), picture) for i, picture in enumerate(pixels)]


def error(pixels: list[np.ndarray], pictures: list[np.ndarray], where: np.ndarray) -> float:
    """Mean over the settled frames of the root mean square error in a part of the picture."""
    pairs = zip(pixels[SETTLED:], pictures[SETTLED:], strict=True)
    return float(
        np.mean([np.sqrt(np.square(a[where] - b[where].astype(float)).mean()) for a, b in pairs])
    )


def restlessness(
    motions: list[SourceMotion], pictures: list[np.ndarray], where: np.ndarray
) -> float:
    """E_warp of a part of the picture, mean over the settled frames [1e-3]."""
    found = []
    for number in range(SETTLED, len(motions)):
        motion, seen = motions[number], motions[number].visible & where
        later = warped(pictures[number + 1].astype(np.float32), motion.steps)
        squares = np.square(later - pictures[number])[seen]
        found.append(squares.mean() / 255**2)
    return 1e3 * float(np.mean(found))


def _keep(folder: Path, name: str, pictures: list[np.ndarray]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for number, picture in enumerate(pictures):
        cv2.imwrite(str(folder / f"{name}_{number:03d}.png"), picture[..., ::-1])


def row(kind: str, pans: bool, options: argparse.Namespace) -> tuple[str, ...]:
    """What the table says about a clip."""
    pixels = clip(kind, options.frames, pans=pans)
    solver = Solver((2 * WIDTH, HEIGHT), options.triangles)
    ways = {"independent": solver.independent(pixels), "followed": solver.followed(pixels)}
    motions = [SourceMotion.between(a, b) for a, b in pairwise(pixels)]
    if options.keep is not None:
        folder = options.keep / f"{kind}_{'pan' if pans else 'still'}"
        _keep(folder, "source", pixels)
        for name, shown in ways.items():
            _keep(folder, name, shown.pictures)
    found: list[list[str]] = [[], []]
    for where in halves():
        own, other = (error(pixels, ways[w].pictures, where) for w in ("followed", "independent"))
        found[0].append(f"{own:.2f} ({100 * (own / other - 1):+.1f} %)")
        measure = partial(restlessness, motions, where=where)
        own, other = (measure(pictures=ways[w].pictures) for w in ("followed", "independent"))
        found[1].append(f"{other / own:.1f}")
    return kind, "pans" if pans else "still", *found[0], *found[1]


def main() -> None:
    """Print the table."""
    parser = program(__doc__)
    parser.add_argument("kinds", nargs="*", default=list(KINDS))
    parser.add_argument("--frames", type=int, default=14)
    parser.add_argument("--triangles", type=int, default=1500)
    parser.add_argument("--keep", type=Path, help="write stills into this folder")
    options = parser.parse_args()
    rows = [row(kind, pans, options) for kind in options.kinds for pans in (False, True)]
    print(table(HEADS, rows))


if __name__ == "__main__":
    main()
