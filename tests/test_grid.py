"""Solutions lie on a grid: what is rounded is little, and what is stored is what was solved."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.track.packing.compact import (
    pack_colors,
    pack_energies,
    pack_numbers,
    pack_places,
    unpack_colors,
    unpack_energies,
    unpack_numbers,
    unpack_places,
)
from pipeline.track.packing.topologies import BaseTriangles, base_frame, pack_topology, topology_of
from pipeline.track.packing.whole_numbers import is_whole, pack_whole, unpack_whole
from stages.mesh import Mesh
from stages.snapshot import colors_at, colors_at_centres
from stages.solve import grid
from stages.solve.color_owners import _twins_of, color_owners
from tests.kernel_samples import random_mesh
from warp_kernels.color_model import COLOR_MODELS, ColorModel

MODELS = tuple(COLOR_MODELS.values())


@pytest.fixture
def mesh() -> Mesh:
    """Triangles of all shapes, slivers among them."""
    return grid.rounded_places(random_mesh(64, 48, 80, seed=5))


def some_colors(mesh: Mesh, model: ColorModel, rng: np.random.Generator) -> np.ndarray:
    """Coefficients as a solution has them, [T, 3, K]."""
    scales = [100.0 / 64 ** (a + b) for a, b in model.exponents]
    return rng.normal(size=(mesh.triangle_count, 3, model.term_count)) * scales


@pytest.mark.parametrize("model", MODELS)
def test_no_colour_moves_by_what_is_seen(
    model: ColorModel, mesh: Mesh, rng: np.random.Generator
) -> None:
    """Anywhere in its triangle, whatever its shape; and rounded again it stays."""
    before = some_colors(mesh, model, rng)
    after = grid.rounded_colors(mesh, model, before)
    shares = rng.dirichlet((1, 1, 1), mesh.triangle_count)
    points = (shares[:, :, None] * mesh.corners).sum(axis=1)
    off = np.abs(colors_at(model, after, points) - colors_at(model, before, points))
    most = 0.5 / grid.SHADES * (1, 1, 2)[model.degree]  # between nodes of a parabola it adds up
    assert 0 < off.max() <= most * (1 + 1e-6)
    np.testing.assert_array_equal(grid.rounded_colors(mesh, model, after), after)


def test_places_and_energies(rng: np.random.Generator) -> None:
    """Half a step; borders stay borders; what would fold stays as it is."""
    mesh = random_mesh(64, 48, 80, seed=5)
    rounded = grid.rounded_places(mesh)
    assert np.abs(rounded.vertices - mesh.vertices).max() <= 0.5 / grid.PLACES
    np.testing.assert_array_equal(rounded.on_left_right, mesh.on_left_right)
    assert grid.rounded_places(rounded) is rounded
    flat = replace(mesh, triangles=mesh.triangles[:1], triangle_ids=mesh.triangle_ids[:1])
    places = mesh.vertices.copy()
    places[flat.triangles[0]] = [[1.0, 1.0], [2.0, 1.0], [1.5, 1.0 + 1e-9]]
    needle = flat.moved(places)
    assert grid.rounded_places(needle) is needle
    energies = np.concatenate([[0.0, 1e-9, 4e9], rng.exponential(1e4, 50)])
    np.testing.assert_allclose(grid.rounded_energies(energies), energies, rtol=2.0**-17)


@pytest.mark.parametrize("model", MODELS)
def test_what_is_packed_is_read_to_the_bit(
    model: ColorModel, mesh: Mesh, rng: np.random.Generator
) -> None:
    """On the grid in few bytes, off it plainly."""
    T = mesh.triangle_count
    counts = rng.integers(0, 9, T)
    counts[counts > 0] += 1
    owners = color_owners(mesh, counts)
    values = grid.shades(mesh, model, some_colors(mesh, model, rng))
    limits = rng.integers(0, 128, (T, 2, 3)).astype(np.uint8) + np.array([[[0], [128]]], np.uint8)
    limits = grid.tightened(model, values, limits)[owners]
    colors = grid.colors_through(mesh, model, values)[owners]
    for given, is_small in ((colors, True), (colors + 1e-9, False), (colors * 1e40, False)):
        blob, bounds = pack_colors(mesh, model, given, counts, limits)
        assert is_whole(blob) == is_small
        found, found_limits = unpack_colors(mesh, model, blob, bounds)
        assert found[counts > 0].tobytes() == given[counts > 0].tobytes()
        assert (found_limits.tobytes(), found_limits.dtype) == (limits.tobytes(), limits.dtype)
        assert pack_colors(mesh, model, given, counts, None)[1] is None
    energies = grid.rounded_energies(rng.exponential(1e4, T))
    for given in (energies, energies + 0.1, energies * 1e60):
        assert unpack_energies(pack_energies(given), T).tobytes() == given.tobytes()
    for given in (mesh.vertices, mesh.vertices + 1e-9):
        found = unpack_places(pack_places(given), len(given))
        assert found.tobytes() == given.tobytes()
    assert unpack_numbers(pack_numbers(counts), T).tobytes() == counts.tobytes()


def test_limits_that_are_not_reached_change_nothing(mesh: Mesh, rng: np.random.Generator) -> None:
    """Clipped to either, a linear colour is the same all over its triangle."""
    model = COLOR_MODELS["linear"]
    values = grid.shades(mesh, model, some_colors(mesh, model, rng))
    colors = grid.colors_through(mesh, model, values)
    middle = rng.integers(60, 180, (mesh.triangle_count, 3))
    limits = np.stack([middle - rng.integers(0, 60), middle + rng.integers(0, 60)], axis=1)
    tight = grid.tightened(model, values, limits.astype(np.uint8))
    assert (tight != limits).any()
    for weights in (*np.eye(3), (0.2, 0.5, 0.3)):
        points = np.einsum("k,tkd->td", weights, mesh.corners)
        shown = colors_at(model, colors, points)
        wide, narrow = (np.clip(shown, b[:, 0], b[:, 1]) for b in (limits, tight))
        np.testing.assert_allclose(narrow, wide, atol=1e-9)


def test_no_colour_lies_between_two_code_values(mesh: Mesh, rng: np.random.Generator) -> None:
    """Where one way to draw rounds it up and another one down; whole ones stay what they are."""
    for model in MODELS[:2]:
        before = some_colors(mesh, model, rng)
        before[:, :, 0] = np.floor(before[:, :, 0]) + 0.5 * (model.degree == 0)
        colors = grid.rounded_colors(mesh, model, before)
        shown = colors_at_centres(mesh, model, colors)
        assert np.abs(shown - np.floor(shown) - 0.5).min() > 0.1 / grid.SHADES
    plain = np.zeros_like(before)
    plain[:, :, 0] = rng.integers(0, 256, plain.shape[:2])
    np.testing.assert_array_equal(grid.rounded_colors(mesh, model, plain), plain)


@pytest.mark.parametrize("width", range(1, 8))
def test_whole_numbers(width: int, rng: np.random.Generator) -> None:
    """Of every width, either sign, and none at all; what is too large is not packed."""
    most = 1 << (8 * width - 1)
    numbers = np.array([0, 1, -1, most - 1, -most, *rng.integers(-most, most, 20)])
    blob = pack_whole(numbers.reshape(5, 5))
    assert blob is not None
    assert (blob[0], is_whole(blob)) == (width, True)
    np.testing.assert_array_equal(unpack_whole(blob, (5, 5)), numbers.reshape(5, 5))
    assert unpack_whole(pack_whole(numbers[:0]), (0,)).shape == (0,)
    assert pack_whole(np.array([1 << 55])) is None
    for bad, shape in ((blob, (5, 4)), (blob, (5, 6)), (blob[:-3], (5, 5)), (b"", (5, 5))):
        with pytest.raises(ValueError, match=r"bytes|rror"):
            unpack_whole(bad, shape)
    with pytest.raises(ValueError, match="numbers of 9 bytes"):
        unpack_whole(b"\x09" + blob[1:], (5, 5))


def test_a_topology_is_told_by_another_where_that_is_shorter(mesh: Mesh) -> None:
    """A few triangles turned; one with nothing in common is told whole."""
    whole = pack_topology(topology_of(mesh))
    base = BaseTriangles(3, len(whole[0]), topology_of(mesh))
    triangles = mesh.triangles.copy()
    triangles[2:4] = triangles[2:4, [1, 2, 0]]
    alike = pack_topology(topology_of(replace(mesh, triangles=triangles)), base)
    assert (base_frame(whole[0]), base_frame(alike[0])) == (None, 3)
    assert len(alike[0]) < 0.4 * len(whole[0])
    other = replace(mesh, triangle_ids=mesh.triangle_ids + 1000, next_triangle_id=2000)
    assert base_frame(pack_topology(topology_of(other), base)[0]) is None


def test_neighbours_of_a_few_triangles(mesh: Mesh) -> None:
    """As the table of all says."""
    rows = np.arange(0, mesh.triangle_count, 3)
    np.testing.assert_array_equal(_twins_of(mesh, rows), mesh.twins.reshape(-1, 3)[rows])
