"""Where the picture boils the mesh is free, and where it is calm it stands still, side by side."""

from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from stages.edits import split_triangles
from stages.flows.dis import Dis
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.layouts.importance import Importance
from stages.mesh import Mesh
from stages.motion.advect import Carried, advect
from stages.motion.boiling import Unrest
from stages.motion.springs import springs_of
from stages.snapshot import Snapshot
from stages.topology import TOPOLOGIES
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from stages.validate import assert_valid
from tests import media_samples as samples
from tests.kernel_samples import frame_of, waves
from tests.meshes import random_mesh
from tests.tracks import rows_of, solve_to
from warp_kernels.device.device import Device

WIDTH, HEIGHT = 192, 96
MIDDLE = WIDTH // 2
COUNT = 260


def blobs(seed: int) -> np.ndarray:
    """Soft spots that have nothing to do with those of another seed, [HEIGHT, MIDDLE, 3]."""
    rough = np.random.default_rng(seed).normal(0, 1, (HEIGHT, MIDDLE, 3))
    soft = cv2.GaussianBlur(rough, (0, 0), 4)
    return np.clip(128 + 60 * soft / soft.std(), 0, 255).astype(np.uint8)


def half_calm(number: int) -> np.ndarray:
    """A frame whose left half stands still and whose right half boils."""
    return np.concatenate([waves(MIDDLE, HEIGHT), blobs(number)], axis=1)


def triangulator(**others) -> Triangulator:
    """One for small pictures."""
    wanted = {"iterations": 80, "refine": RefineOptions(triangles=COUNT), **others}
    return Triangulator(Device("cpu"), (WIDTH, HEIGHT), TriangulateOptions(**wanted))


def first_of(solver: Triangulator, picture: np.ndarray, number: int = 0) -> Snapshot:
    """A picture from scratch."""
    return solver.first(frame_of(picture, number), Importance(), np.random.default_rng(1))


def carried(before: Snapshot, earlier: np.ndarray, later: np.ndarray) -> Carried:
    """A mesh in the next picture."""
    return advect(before.mesh, Passage.between(Dis(), View(earlier), View(later)))


def unrest_of(earlier: np.ndarray, later: np.ndarray) -> tuple[Mesh, Unrest | None]:
    """What is told of a picture after another one, and the mesh that came along."""
    solver = triangulator()
    before = first_of(solver, earlier)
    seed = carried(before, earlier, later)
    solver.fit(frame_of(later, 1), seed.mesh)
    energies = solver.fit(frame_of(later, 1), seed.mesh).energies
    return seed.mesh, Unrest.between(before, seed, energies)


@lru_cache
def followed(topology: str) -> tuple[Snapshot, ...]:
    """Four frames of the clip."""
    solver = triangulator(topology=topology)
    found = [first_of(solver, half_calm(0))]
    for number in range(1, 4):
        seed = carried(found[-1], half_calm(number - 1), half_calm(number))
        found.append(solver.next(frame_of(half_calm(number), number), seed, found[-1]))
        assert_valid(found[-1].mesh)
    return tuple(found)


def error_of(snapshot: Snapshot, *, right: bool) -> float:
    """Root of the energy of a half's triangles."""
    centres = snapshot.mesh.corners.mean(axis=1)
    return float(np.sqrt(snapshot.energies[(centres[:, 0] > MIDDLE) == right].sum()))


def test_what_boils_is_told_from_what_is_calm() -> None:
    """By place: all of one half and nothing of the other, but for what lies along the seam."""
    mesh, unrest = unrest_of(half_calm(0), half_calm(1))
    assert unrest is not None
    x = mesh.vertices[:, 0]
    assert unrest.values[x > MIDDLE + 16].mean() > 0.9
    calm = unrest.values[x < MIDDLE - 24]
    assert calm.mean() < 0.05
    assert calm.max() < 0.5


def changes() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Pairs of pictures that differ, and do not boil."""
    still = np.concatenate([waves(MIDDLE, HEIGHT), blobs(0)], axis=1)
    rng = np.random.default_rng(3)
    grain = [
        np.clip(still + rng.normal(0, 25, (HEIGHT, WIDTH, 1)), 0, 255).astype(np.uint8)
        for _ in range(2)
    ]
    wide = np.concatenate([still, still[:, ::-1]], axis=1)
    return {
        "nothing": (still, still),
        "a flash": (still // 2, still // 2 + 60),
        "a fade": (still, (0.7 * still).astype(np.uint8)),
        "grain": (grain[0], grain[1]),
        "a pan": (wide[:, :WIDTH], wide[:, 5 : WIDTH + 5]),
    }


@pytest.mark.parametrize("name", changes())
def test_what_changes_otherwise_does_not_boil(name: str) -> None:
    """Light, grain and motion change pixels, too, but there following pays."""
    assert unrest_of(*changes()[name])[1] is None


def test_springs_let_go_where_it_boils() -> None:
    """Those of the calm half are firm, those of the other one weak."""
    before = first_of(triangulator(), half_calm(0))
    seed = carried(before, half_calm(0), half_calm(1))
    mesh, unrest = unrest_of(half_calm(0), half_calm(1))
    assert unrest is not None
    np.testing.assert_array_equal(mesh.vertices, seed.mesh.vertices)
    strengths = springs_of(mesh, unrest.freed(seed), 1.0, None)[:, 2]
    x = mesh.vertices[:, 0]
    calm = strengths[x < MIDDLE - 24]
    assert strengths[x > MIDDLE + 16].mean() < 0.02 * calm.mean()
    assert calm.min() > 0.5 * calm.max()


def test_calm_half_stays_and_the_other_fits() -> None:
    """Vertices beside what boils stay where they are; what boils fits as if it were alone."""
    found = followed("energy")
    for before, after in pairwise(found):
        calm = np.flatnonzero(before.mesh.vertices[:, 0] < MIDDLE - 24)
        kept = np.isin(before.mesh.vertex_ids[calm], after.mesh.vertex_ids)
        assert kept.mean() > 0.9
        old = calm[kept]
        new = np.searchsorted(after.mesh.vertex_ids, before.mesh.vertex_ids[old])
        moved = np.linalg.norm(after.mesh.vertices[new] - before.mesh.vertices[old], axis=1)
        assert np.median(moved) < 0.05
        assert np.quantile(moved, 0.9) < 0.5
    alone = first_of(triangulator(), half_calm(3), 3)
    assert error_of(found[3], right=True) < 1.1 * error_of(alone, right=True)
    assert error_of(found[3], right=False) < 1.1 * error_of(alone, right=False)


@pytest.mark.parametrize("topology", TOPOLOGIES)
def test_number_of_triangles_stays(topology: str) -> None:
    """What was inserted on the way is taken away again."""
    for snapshot in followed(topology):
        assert abs(snapshot.mesh.triangle_count - COUNT) <= 1


def test_new_vertices_are_like_those_around() -> None:
    """Also those that have only new ones beside them."""
    mesh = random_mesh(4)
    right = (mesh.vertices[:, 0] > mesh.width / 2).astype(float)
    unrest = Unrest(mesh.vertex_ids, right)
    finer = mesh
    for _ in range(3):
        finer = split_triangles(finer, np.arange(finer.triangle_count))
    values = unrest.at(finer)
    assert np.array_equal(values[: mesh.vertex_count], right)
    assert ((values >= 0) & (values <= 1)).all()
    x = finer.vertices[:, 0]
    assert values[x > 0.8 * mesh.width].min() > 0.9
    assert values[x < 0.2 * mesh.width].max() < 0.1


def test_what_goes_on_equals_the_whole(tmp_path: Path) -> None:
    """A track tells the next frame how well triangles fitted, to the bit."""
    clip = samples.write_video(tmp_path / "in.mp4", [half_calm(number) for number in range(5)])
    wanted = TriangulateOptions(
        iterations=16, frame_iterations=16, refine=RefineOptions(triangles=120)
    )
    whole, parts = tmp_path / "whole.mtrk", tmp_path / "parts.mtrk"
    solve_to(whole, clip, triangulate=wanted, cuts="none")
    solve_to(parts, clip, "0-2", triangulate=wanted, cuts="none")
    solve_to(parts, clip, triangulate=wanted, cuts="none", resume=True)
    assert rows_of(parts)["meshes"] == rows_of(whole)["meshes"]
