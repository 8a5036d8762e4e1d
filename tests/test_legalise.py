"""Delaunay restoration by flips against SciPy's triangulation of the same points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import random_mesh, scrambled, triangle_set, two_triangles
from scipy.spatial import Delaunay

from stages.edits import (
    flip_edges,
    flippable,
    independent_flips,
    legalise,
    split_edges,
    split_triangles,
)
from stages.layouts import LAYOUTS
from stages.mesh import Mesh, mesh_of, twins_of
from stages.motion.correspondence import kept_triangles
from stages.validate import assert_valid


def split_only(seed: int, triangle_count: int) -> Mesh:
    """A mesh of bad shape: random points put into the triangles they hit, never a flip."""
    rng = np.random.default_rng(seed)
    mesh = split_edges(two_triangles(), [0], [(1.3, 0.0)])
    while mesh.triangle_count < triangle_count:
        chosen = np.flatnonzero(rng.random(mesh.triangle_count) < 0.7)
        weights = rng.dirichlet([2, 2, 2], len(chosen))
        points = np.einsum("nc,ncx->nx", weights, mesh.vertices[mesh.triangles[chosen]])
        mesh = split_triangles(mesh, chosen, points)
    return mesh


def assert_delaunay(mesh: Mesh) -> None:
    """Check a mesh in general position against SciPy."""
    assert_valid(mesh)
    assert triangle_set(mesh.triangles) == triangle_set(Delaunay(mesh.vertices).simplices)
    assert np.array_equal(mesh.twins, twins_of(mesh.triangles, mesh.vertex_count))


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), inner=st.integers(0, 150))
def test_scrambled_meshes_come_back(seed: int, inner: int) -> None:
    """Random flips of a Delaunay mesh are all undone."""
    assert_delaunay(legalise(scrambled(random_mesh(seed, inner), seed)))


@pytest.mark.parametrize(("seed", "triangle_count"), [(0, 30), (1, 300), (2, 3000), (3, 8000)])
def test_bad_meshes_become_delaunay(seed: int, triangle_count: int) -> None:
    """Insertion without any flip makes needles; the flips mend them all."""
    assert_delaunay(legalise(split_only(seed, triangle_count)))


def test_five_thousand_points() -> None:
    """A large random mesh, scrambled, equals SciPy's triangulation."""
    assert_delaunay(legalise(scrambled(random_mesh(11, inner=5000), 11)))


@pytest.mark.parametrize("seed", range(5))
def test_local_restoration_after_insertion(seed: int) -> None:
    """Marking the new triangles is enough to restore a Delaunay mesh after splits."""
    mesh = random_mesh(seed, inner=400)
    chosen = np.random.default_rng(seed).choice(mesh.triangle_count, 40, replace=False)
    split = split_triangles(mesh, chosen)
    restored = legalise(split, kept_triangles(mesh, split) < 0)
    assert_delaunay(restored)
    far = np.isin(np.arange(mesh.triangle_count), kept_triangles(mesh, restored))
    assert far.mean() > 0.3  # what no flip reached is as it was


def test_what_no_flip_reached_is_as_it_was() -> None:
    """Where no flip was undone rows and ids are those before."""
    mesh = random_mesh(6)
    edges = mesh.edge_half_edges[::40]
    edges = edges[flippable(mesh, edges)]
    bad = flip_edges(mesh, edges[independent_flips(mesh, edges)])
    restored = legalise(bad)
    assert triangle_set(restored.triangles) == triangle_set(mesh.triangles)
    kept = kept_triangles(bad, restored)
    assert 0 < (kept < 0).sum() < 0.2 * mesh.triangle_count
    assert np.array_equal(restored.triangles[kept >= 0], bad.triangles[kept[kept >= 0]])
    assert np.array_equal(restored.triangle_ids[kept >= 0], bad.triangle_ids[kept[kept >= 0]])
    assert np.array_equal(restored.twins, twins_of(restored.triangles, restored.vertex_count))


def test_nothing_to_do_returns_the_same_mesh() -> None:
    """A Delaunay mesh comes back as the same object, and so does one that nobody suspects."""
    mesh = random_mesh(7)
    assert legalise(mesh) is mesh
    bad = scrambled(mesh, 7)
    assert legalise(bad, np.zeros(bad.triangle_count, dtype=bool)) is bad


@pytest.mark.parametrize("scale", [1.0, 0.1, 1 / 3])
def test_cocircular_points_end(scale: float) -> None:
    """On a regular grid, where four points share every circle, the flips end in right angles."""
    pixels = np.zeros((40, 40, 3), dtype=np.uint8)
    grid = LAYOUTS["grid"]().build(pixels, 800, np.random.default_rng(0))
    grid = mesh_of(grid.vertices * scale, grid.triangles, 40 * scale, 40 * scale)
    restored = legalise(scrambled(grid, 0, rounds=8))
    assert_valid(restored)
    assert restored.areas == pytest.approx(np.full(800, 2.0 * scale**2))


def test_points_on_a_circle_end() -> None:
    """Many points of one circle around its centre leave no inverted or flat triangle."""
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = 50 + 40 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([[[0, 0], [100, 0], [0, 100], [100, 100]], ring])
    mesh = mesh_of(points, Delaunay(points).simplices, 100, 100)
    restored = legalise(scrambled(mesh, 1, rounds=12))
    assert_valid(restored)
    assert restored.heights.min() > 1e-6
