"""Held vertices go with the picture; locks end where something covers them or they leave."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from stages.flows.dis import Dis
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.hand.locks import NO_LOCKS
from stages.mesh import Mesh
from stages.motion.advect import advect
from stages.motion.held_path import held_path
from tests.meshes import HEIGHT, WIDTH, random_mesh

SCALE = 4
"""Pictures are larger than the meshes of the tests, so that patches hold something."""


def texture(seed: int, size: tuple[int, int]) -> np.ndarray:
    """Soft spots of any colours, [H, W, 3] uint8."""
    noise = np.random.default_rng(seed).integers(0, 256, (size[1], size[0], 3)).astype(np.uint8)
    soft = cv2.GaussianBlur(noise, (0, 0), 1.5).astype(float)
    return np.clip((soft - soft.mean()) * 6.0 + 128.0, 0, 255).astype(np.uint8)


def moved(shift: tuple[int, int]) -> Passage:
    """A picture of which the whole moves."""
    size = SCALE * WIDTH, SCALE * HEIGHT
    wide = texture(1, (size[0] + 40, size[1] + 40))
    views = [
        View(np.ascontiguousarray(wide[20 - y : 20 - y + size[1], 20 - x : 20 - x + size[0]]))
        for x, y in ((0, 0), shift)
    ]
    return Passage.between(Dis(), *views)


def large_mesh() -> Mesh:
    """A mesh of the size of the pictures."""
    mesh = random_mesh(3, inner=150)
    scaled = Mesh(
        vertices=SCALE * mesh.vertices,
        triangles=mesh.triangles,
        vertex_ids=mesh.vertex_ids,
        triangle_ids=mesh.triangle_ids,
        width=SCALE * WIDTH,
        height=SCALE * HEIGHT,
        next_vertex_id=mesh.next_vertex_id,
        next_triangle_id=mesh.next_triangle_id,
    )
    return scaled


def test_what_stays_in_sight_is_held_where_the_picture_takes_it() -> None:
    mesh = large_mesh()
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    size = np.array([mesh.width, mesh.height])
    middle = inner & ((mesh.vertices > 30) & (mesh.vertices < size - 30)).all(axis=1)
    locks = NO_LOCKS.adding(vertices=mesh.vertex_ids[middle])
    passage = moved((7, -4))
    steps, _ = passage.follow(mesh.vertices)
    steps, left = held_path(mesh, steps, passage, locks)
    assert np.array_equal(left.vertices, locks.vertices)
    assert np.abs(steps[middle] - (7, -4)).max() < 0.5


def turned(degrees: float, zoom: float) -> tuple[Passage, np.ndarray]:
    """A picture that turns and grows about its middle, and by which matrix places do."""
    size = SCALE * WIDTH, SCALE * HEIGHT
    matrix = cv2.getRotationMatrix2D((size[0] / 2 - 0.5, size[1] / 2 - 0.5), degrees, zoom)
    before = texture(1, size)
    views = View(before), View(cv2.warpAffine(before, matrix, size, flags=cv2.INTER_CUBIC))
    return Passage.between(Dis(), *views), matrix[:, :2]


@pytest.mark.parametrize(("degrees", "zoom"), [(2.0, 1.0), (0.0, 1.03), (-1.5, 0.98)])
def test_what_turns_and_stretches_is_held_in_its_place(degrees: float, zoom: float) -> None:
    """Past bug: the middle of a patch went where its contrast did, and chains drifted."""
    mesh = large_mesh()
    size = np.array([mesh.width, mesh.height])
    middle = ((mesh.vertices > 30) & (mesh.vertices < size - 30)).all(axis=1)
    locks = NO_LOCKS.adding(vertices=mesh.vertex_ids[middle])
    passage, matrix = turned(degrees, zoom)
    steps, _ = passage.follow(mesh.vertices)
    steps, _ = held_path(mesh, steps, passage, locks)
    away = mesh.vertices - size / 2
    misses = np.linalg.norm(steps - (away @ matrix.T - away), axis=1)[middle]
    assert np.median(misses) < 0.03
    assert misses.max() < 0.2


def held_after(mesh: Mesh, vertices: np.ndarray, pictures: list[np.ndarray]) -> np.ndarray:
    """Which of some held vertices are held in the last one of several pictures, [N] bool."""
    locks = NO_LOCKS.adding(vertices=vertices)
    views = [View(pixels) for pixels in pictures]
    for earlier, later in pairwise(views):
        carried = advect(mesh, Passage.between(Dis(), earlier, later), locks)
        mesh, locks = carried.mesh, carried.locks
    return np.isin(vertices, locks.vertices)


def test_locks_of_what_leaves_the_picture_end() -> None:
    mesh = large_mesh()
    across = mesh.vertices[:, 0]
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    ids = mesh.vertex_ids[inner]
    wide = texture(1, (mesh.width + 60, mesh.height))
    pictures = [
        np.ascontiguousarray(wide[:, 60 - d : 60 - d + mesh.width]) for d in range(0, 61, 12)
    ]
    held = held_after(mesh, ids, pictures)
    gone = across[inner] > mesh.width - 48
    far = (across[inner] < mesh.width - 80) & (across[inner] > 20)
    assert gone.sum() > 5
    assert not held[gone].any()
    assert held[far].mean() > 0.9


def test_locks_of_what_is_covered_end() -> None:
    """A card slides over a part of the picture; what it covers is let go, all else is held."""
    mesh = large_mesh()
    ground, card = texture(1, (mesh.width, mesh.height)), texture(2, (120, 160))
    pictures = []
    for left in range(40, 137, 12):
        pixels = ground.copy()
        pixels[40:200, left : left + 120] = card
        pictures.append(pixels)
    x, y = mesh.vertices.T
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    covered = inner & (y > 52) & (y < 188) & (x > 172) & (x < 220)
    apart = inner & (x > 290) & (x < mesh.width - 16) & (y > 16) & (y < mesh.height - 16)
    assert covered.sum() > 5
    held = held_after(mesh, mesh.vertex_ids, pictures)
    assert held[covered].mean() <= 0.3  # by chance a patch of the card looks like what it covers
    assert held[apart].all()
