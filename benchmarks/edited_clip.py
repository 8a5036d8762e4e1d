"""What edits by hand do to a film: held vertices, coherence, the seam of two edited frames.

    python -m benchmarks.edited_clip [CLIP] [--frames A-B] [--triangles N] [--seed N]

Big Buck Bunny three times, all drawn without loss: not edited; with 60 vertices put on the face in
frame 60, ten of them moved and three edges flipped; with vertices put there in frames 40 and 80.
CLIP is one of 132 frames; the sample has the first 75 of them.

Held vertices are compared with chains of patches of 21x21 px from frame to frame, each checked by
its way back; a chain that does not come back ends there, for what it was on is covered or gone.
Chains are found in two ways: by pyramids of Lucas and Kanade, with which the program begins, and by
the best normalised cross-correlation around, of which it knows nothing. Patches of both do not turn
or stretch, and drift where the picture does: see `benchmarks.known_motion`. Printed are the
shares of what patches see that lives as a held vertex, and that lives and is near; E_warp of the
clips; rmse around the face, whose places are those of the patches; the largest E_warp where two
edited frames meet, beside the median of the clip and beside the same frames without edits.
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

from pipeline.compare.measure import measure
from pipeline.compare.report import Report
from pipeline.loop.animate import animate
from pipeline.options.edit_log import EditLog
from pipeline.options.job import Job
from pipeline.options.output import Output
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.hand import Edit
from stages.hand.flip_edge import FlipEdge
from stages.hand.insert import Insert
from stages.hand.move_vertex import MoveVertex
from stages.hand.worked import Worked
from stages.media import FrameRange, open_decoder
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from warp_kernels.errors import EditError

CLIP = Path(__file__).parents[1] / "sample_videos" / "bigbuckbunny.mp4"
AT, FIRST, LAST = 60, 30, 90
"""The frame that is edited, and those in which held vertices are looked for."""
SEAMED = (40, 80)
"""Frames that are edited in the third film."""
MEETS = 7
"""Frames before and after the middle between them in which their solutions meet."""
FACE, RADIUS = (452.0, 140.0), 55.0
"""Where the face is in all of these, and how large [px]."""
INSERTED, MOVED, FLIPPED = 60, 10, 3
STEP = np.array([2.0, -1.5])
"""How far vertices are moved [px]."""
NEAR = 1.5
"""So far from their patches held vertices may be [px]."""
PATCH, LEVELS, WAY_BACK = 21, 3, 1.0
"""Size of a patch [px], halvings of a pyramid, how far from its begin a way back may end [px]."""
SEARCH, ALIKE, FINER = 12, 0.8, 4
"""How far patches are sought [px], the least correlation of what is the same thing, and values a
pixel where the best place is sought between pixels."""
Way = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
AROUND = range(55, 66)
"""Frames in which the face is compared with the source."""


@dataclass(frozen=True)
class Film:
    """What one solution became."""

    track: Path
    """Its meshes."""
    stills: Path
    """Its frames, as a pattern of numbered stills."""
    report: Report
    """How it compares with the source."""

    @property
    def warp_error(self) -> float:
        """E_warp of the clip [1e-3]."""
        found = self.report.coherence.warp_errors[1]
        assert found is not None
        return 1e3 * found

    def still(self, frame: int) -> np.ndarray:
        """A frame, [rows, columns, 3] float64."""
        place = [figures.frame for figures in self.report.frames].index(frame)
        found = cv2.imread(str(self.stills).replace("####", f"{place:04d}"))
        return found[..., ::-1].astype(float)


def solved(options: SolveOptions, edits: EditLog | None, name: str, folder: Path) -> Film:
    """Convert the clip and compare it with its source."""
    track, stills = folder / f"{name}.mtrk", folder / f"{name}_####.png"
    own = SolveOptions(
        options.source, options.frame_range, triangulate=options.triangulate, edits=edits
    )
    result = animate(Job(own, output=Output(stills, track=track)), Progress())
    for warning in result.warnings:
        print(f"{name}: {warning}")
    report = measure(options.source, stills, options.frame_range, track)
    return Film(track, stills, report)


def edits_of(track: Path, seed: int) -> EditLog:
    """Vertices on the face, some of them moved, edges around some flipped; all can be made."""
    rng = np.random.default_rng(seed)
    with TrackReader(track) as reader:
        worked = Worked(reader.snapshot(AT).mesh)
    made: list[Edit] = [Insert(AT, FACE, RADIUS, INSERTED, seed=seed)]
    known = worked.mesh.next_vertex_id
    worked = made[0].apply(worked)
    fresh = np.flatnonzero(worked.mesh.vertex_ids >= known)
    tried: list[tuple[int, Edit]] = []
    for at in worked.mesh.vertices[rng.permutation(fresh)]:
        (x, y), (u, v) = at, at + STEP
        tried.append((MOVED, MoveVertex(AT, (float(x), float(y)), (float(u), float(v)))))
    for angle in rng.uniform(0, 2 * np.pi, 60):
        x, y = FACE + RADIUS * 0.6 * np.array([np.cos(angle), np.sin(angle)])
        tried.append((MOVED + FLIPPED, FlipEdge(AT, (float(x), float(y)))))
    for most, edit in tried:
        if len(made) > most:
            continue
        try:
            worked = edit.apply(worked)
        except EditError:
            continue
        made.append(edit)
    kinds = [type(edit).__name__ for edit in made]
    assert [kinds.count(n) for n in ("MoveVertex", "FlipEdge")] == [MOVED, FLIPPED]
    return EditLog(tuple(made))


def by_gradients(before: np.ndarray, after: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Where patches went by Lucas and Kanade, [N, 2] px of the pixels' centres; NaN if unknown."""
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        before, after, at.astype(np.float32), None, winSize=(PATCH, PATCH), maxLevel=LEVELS
    )
    return np.where(status == 1, found, np.nan)


def by_correlation(before: np.ndarray, after: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Where patches went by cross-correlation, [N, 2] px of the pixels' centres; NaN if unknown."""
    found = np.full((len(at), 2), np.nan)
    reach = PATCH // 2 + SEARCH
    for n, (x, y) in enumerate(at):
        column, row = round(x), round(y)
        inside = reach <= column < before.shape[1] - reach
        if not inside or not reach <= row < before.shape[0] - reach:
            continue
        patch = cv2.getRectSubPix(before, (PATCH, PATCH), (float(x), float(y)))
        window = after[row - reach : row + reach + 1, column - reach : column + reach + 1]
        scores = cv2.matchTemplate(window, patch, cv2.TM_CCOEFF_NORMED)
        v, u = np.unravel_index(scores.argmax(), scores.shape)
        if scores[v, u] < ALIKE or not (0 < v < 2 * SEARCH and 0 < u < 2 * SEARCH):
            continue
        near = np.array([column - SEARCH + u, row - SEARCH + v], dtype=float)
        found[n] = _closer(before, after, np.array([x, y], dtype=float), near)
    return found


def _closer(before: np.ndarray, after: np.ndarray, at: np.ndarray, near: np.ndarray) -> np.ndarray:
    """The best correlation within a pixel of a place, to a small part of a pixel, [2] px.

    A parabola through scores of whole pixels leans towards whole ones, by up to a tenth of a pixel
    in every frame: chains of it drift.
    """
    patch = _fine(before, at, PATCH // 2)
    scores = cv2.matchTemplate(_fine(after, near, PATCH // 2 + 1), patch, cv2.TM_CCOEFF_NORMED)
    v, u = np.clip(np.unravel_index(scores.argmax(), scores.shape), 1, 2 * FINER - 1)
    peaks = (_peak(line) for line in (scores[v, u - 1 : u + 2], scores[v - 1 : v + 2, u]))
    offset = np.array([u, v]) + np.fromiter(peaks, dtype=float)
    return near + offset / FINER - 1


def _fine(picture: np.ndarray, at: np.ndarray, reach: int) -> np.ndarray:
    """The square around a place between pixels, with several values a pixel."""
    steps = np.arange(-reach * FINER, reach * FINER + 1) / FINER
    x, y = np.meshgrid(at[0] + steps, at[1] + steps)
    kind = cv2.INTER_LANCZOS4
    return cv2.remap(picture, x.astype(np.float32), y.astype(np.float32), kind)


def _peak(scores: np.ndarray) -> float:
    """Where the parabola through three scores is highest, beside the middle one [px]."""
    left, middle, right = scores.tolist()
    bend = left - 2 * middle + right
    return 0.0 if bend == 0 else 0.5 * (left - right) / bend


WAYS: dict[str, Way] = {"gradients": by_gradients, "correlation": by_correlation}
"""How patches are found again."""


def chains(
    clip: Path, frames: range, places: np.ndarray, way: Way
) -> Iterator[tuple[int, np.ndarray]]:
    """Where patches of the first of some frames are in the others, [N, 2]; NaN once unseen.

    Args:
        clip: The source.
        frames: Numbers of the frames, in the order of the way.
        places: Where they are in the first one [px].
        way: How they are found again.
    """
    with open_decoder(clip, FrameRange(min(frames), max(frames))) as decoder:
        grays = {f.index: cv2.cvtColor(f.pixels, cv2.COLOR_RGB2GRAY) for f in decoder}
    at = places - 0.5  # whose pixels' centres are whole numbers
    yield frames[0], at + 0.5
    for before, frame in pairwise(frames):
        known = np.flatnonzero(~np.isnan(at[:, 0]))
        there = way(grays[before], grays[frame], at[known])
        told = ~np.isnan(there[:, 0])
        known, there = known[told], there[told]
        back = way(grays[frame], grays[before], there)
        comes = norm(back - at[known], axis=1) < WAY_BACK
        at = np.full_like(at, np.nan)
        at[known[comes]] = there[comes]
        yield frame, at + 0.5


def places_of(track: Path, frame: int, ids: np.ndarray) -> np.ndarray:
    """Where held vertices are, [N, 2] px; NaN where they do not live or are not held any more."""
    with TrackReader(track) as reader:
        snapshot = reader.snapshot(frame)
    mesh = snapshot.mesh
    row = {int(number): n for n, number in enumerate(mesh.vertex_ids)}
    held = set(snapshot.locks.vertices.tolist())
    found = [mesh.vertices[row[i]] if i in row and i in held else (np.nan,) * 2 for i in ids]
    return np.array(found)


def follow(clip: Path, edited: Film, by: str) -> dict[int, np.ndarray]:
    """Print how held vertices keep to the picture; where the patches are in each frame."""
    with TrackReader(edited.track) as reader:
        ids = reader.snapshot(AT).locks.vertices
    begun = places_of(edited.track, AT, ids)
    seen = alive = near = 0
    where: dict[int, np.ndarray] = {}
    distances = []
    for frames in (range(AT, LAST + 1), range(AT, FIRST - 1, -1)):
        for frame, patches in chains(clip, frames, begun, WAYS[by]):
            where[frame] = patches
            if frame == AT:
                continue
            known = ~np.isnan(patches[:, 0])
            apart = norm(places_of(edited.track, frame, ids) - patches, axis=1)[known]
            distances.append(apart)
            seen += int(known.sum())
            alive += int(np.isfinite(apart).sum())
            near += int((apart <= NEAR).sum())
    total = len(ids) * (LAST - FIRST)
    print(
        f"{len(ids)} held vertices, patches by {by} see {seen / total:.1%} of them in frames "
        f"{FIRST}-{LAST}; of those live {alive / seen:.1%}, within {NEAR} px {near / seen:.1%}, "
        f"middle distance {np.nanmedian(np.concatenate(distances)):.2f} px",
        flush=True,
    )
    return where


def face_error(clip: Path, film: Film, where: dict[int, np.ndarray]) -> float:
    """Rmse in the disc around the patches [code values]."""
    squares = []
    with open_decoder(clip, FrameRange(AROUND[0], AROUND[-1])) as decoder:
        for frame in decoder:
            x, y = np.nanmedian(where[frame.index], axis=0)
            rows, columns = np.indices(frame.pixels.shape[:2]) + 0.5
            disc = np.hypot(columns - x, rows - y) <= RADIUS
            squares.append(((frame.pixels - film.still(frame.index)) ** 2)[disc].mean())
    return float(np.sqrt(np.mean(squares)))


def seam(film: Film, plain: Film) -> str:
    """What is said of the frames in which two edited ones meet."""
    errors, own = (
        {f.frame: f.coherence.warp_errors[1] or 0.0 for f in one.report.frames if f.frame}
        for one in (film, plain)
    )
    middle = sum(SEAMED) // 2
    meeting = range(middle - MEETS, middle + MEETS + 1)
    usual = np.median(list(errors.values()))
    found, without = (max(of[frame] for frame in meeting) for of in (errors, own))
    most = max(errors[frame] / own[frame] for frame in range(SEAMED[0] + 1, SEAMED[1] + 1))
    return (
        f"seam, frames {meeting[0]}-{meeting[-1]}: largest E_warp {found / usual:.2f} medians of "
        f"the clip, {without / np.median(list(own.values())):.2f} without edits; frames "
        f"{SEAMED[0] + 1}-{SEAMED[1]}: at most {most:.2f} times the same frame without edits"
    )


def main() -> None:
    """Run all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clip", type=Path, nargs="?", default=CLIP)
    parser.add_argument("--frames", default="0-131")
    parser.add_argument("--triangles", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1, help="of the edits")
    given = parser.parse_args()
    wanted = TriangulateOptions(refine=RefineOptions(triangles=given.triangles))
    options = SolveOptions(given.clip, FrameRange.parse(given.frames), triangulate=wanted)
    with TemporaryDirectory() as name:
        folder = Path(name)
        plain = solved(options, None, "plain", folder)
        if plain.report.frames[-1].frame < LAST:
            raise SystemExit(f"{given.clip}: ends before frame {LAST}; give the whole clip as CLIP")
        edited = solved(options, edits_of(plain.track, given.seed), "edited", folder)
        where, _ = [follow(given.clip, edited, way) for way in WAYS]
        change = edited.warp_error / plain.warp_error - 1
        print(f"E_warp {edited.warp_error:.4f} for {plain.warp_error:.4f} 1e-3: {change:+.1%}")
        faces = [face_error(given.clip, film, where) for film in (edited, plain)]
        print("face rmse {:.2f} for {:.2f}".format(*faces), flush=True)
        log = EditLog(tuple(Insert(f, FACE, RADIUS, INSERTED, seed=given.seed) for f in SEAMED))
        both = solved(options, log, "both", folder)
        print(seam(both, plain))


if __name__ == "__main__":
    main()
