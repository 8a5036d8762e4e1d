"""Patches decide how points move, and what is covered goes."""

import cv2
import numpy as np
import pytest
from meshes import HEIGHT, WIDTH, random_mesh, scrambled

from stages.flows.dis import Dis
from stages.flows.field import FlowField
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.layouts.grid import Grid
from stages.motion.occlusion import collapse_covered
from stages.validate import assert_valid

SIZE = 96


def texture(seed: int) -> np.ndarray:
    """Smooth random colours, [SIZE, SIZE, 3] uint8."""
    noise = np.random.default_rng(seed).random((SIZE, SIZE, 3)).astype(np.float32)
    smooth = cv2.GaussianBlur(noise, (0, 0), 2)
    return cv2.normalize(smooth, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8)


def card(left: int) -> np.ndarray:
    """A textured card of 40 px before a textured ground."""
    picture = texture(0)
    picture[30:70, left : left + 40] = texture(1)[:40, :40]
    return picture


def field(motion: np.ndarray) -> FlowField:
    """A flow of one vector per pixel."""
    return FlowField(SIZE, SIZE, motion.astype(np.float32))


def passage_along(flow: FlowField, earlier: np.ndarray, later: np.ndarray) -> Passage:
    """A passage between pictures [SIZE, SIZE, 3] whose motion is given."""
    return Passage(flow, View(earlier), View(later))


def test_points_on_an_outline_move_with_what_is_in_front() -> None:
    """The estimate gives the card's rim the motion of the ground; its patches know better."""
    motion = np.zeros((SIZE, SIZE, 2))
    motion[33:67, 23:57, 0] = 5.0  # 3 px of the card are missed on every side
    passage = passage_along(field(motion), card(20), card(25))
    rim = np.array([[21.0, y] for y in (40.0, 50.0, 60.0)])
    assert np.array_equal(passage.flow.at(rim), np.zeros((3, 2)))
    steps, _ = passage.follow(rim)
    assert np.array_equal(steps, np.tile([5.0, 0.0], (3, 1)))


def test_what_stands_still_is_seen_to_stand() -> None:
    """On a faint slope a motion of 3 px fits nearly as well; standing still fits, and wins."""
    slope = np.repeat((np.arange(SIZE) // 6).astype(np.uint8)[None, :, None], SIZE, axis=0)
    slope = np.repeat(slope, 3, axis=2)
    motion = np.zeros((SIZE, SIZE, 2))
    motion[..., 0] = 3.0
    steps, _ = passage_along(field(motion), slope, slope).follow(np.array([[40.0, 50.0]]))
    assert np.array_equal(steps, [[0.0, 0.0]])


def test_a_right_flow_is_kept_and_trusted() -> None:
    """Where the flow is right its own motion wins, inside of the card and beside it."""
    motion = np.zeros((SIZE, SIZE, 2))
    motion[30:70, 20:60, 0] = 5.0
    passage = passage_along(field(motion), card(20), card(25))
    steps, trust = passage.follow(np.array([[40.0, 50.0], [80.0, 15.0]]))
    assert np.array_equal(steps, [[5.0, 0.0], [0.0, 0.0]])
    assert np.array_equal(trust, [1.0, 1.0])


def test_what_no_motion_explains_is_not_trusted() -> None:
    """Another picture altogether leaves next to nothing to hold on to."""
    passage = passage_along(FlowField.still(SIZE, SIZE), texture(2), texture(3))
    _, trust = passage.follow(np.random.default_rng(0).uniform(8, SIZE - 8, (50, 2)))
    assert np.median(trust) < 0.02


def test_plain_pictures_follow_the_flow() -> None:
    """Where nothing can be seen nothing speaks against the flow."""
    plain = np.full((SIZE, SIZE, 3), 90, np.uint8)
    motion = np.full((1, 1, 2), 2.5, np.float32)
    steps, trust = passage_along(FlowField(SIZE, SIZE, motion), plain, plain).follow(
        np.array([[0.0, 0.0], [50.0, 50.0], [96.0, 20.0]])
    )
    assert (steps == 2.5).all()
    assert (trust == 1.0).all()


def test_only_equal_pictures_stand_still() -> None:
    """One code value is a difference."""
    other = texture(0)
    other[3, 4, 1] ^= 1
    assert Passage.between(Dis(), View(texture(0)), View(texture(0))).is_still
    assert not Passage.between(Dis(), View(texture(0)), View(other)).is_still


def test_a_band_that_is_covered_collapses() -> None:
    """A card slides over two layers of triangles: they go, and no vertex is held back."""
    mesh = Grid().build(np.zeros((60, 80, 3), np.uint8), 96, np.random.default_rng(0))
    in_front = (mesh.vertices[:, 0] > 5) & (mesh.vertices[:, 0] < 35)
    in_front &= (mesh.vertices[:, 1] > 5) & (mesh.vertices[:, 1] < 55)
    steps = np.where(in_front[:, None], (23.0, 0.0), 0.0)
    kept, rest = collapse_covered(mesh, steps, 0.25)
    assert_valid(kept)
    assert kept.triangle_count < mesh.triangle_count
    assert np.isin(kept.triangle_ids, mesh.triangle_ids).all()
    moved = kept.moved(kept.vertices + rest)
    assert (moved.heights >= 0.25).all()
    assert_valid(moved)


@pytest.mark.parametrize("seed", range(4))
def test_covering_keeps_meshes_valid_whatever_the_steps(seed: int) -> None:
    """Random steps leave a valid mesh at its old places and a step for each vertex."""
    mesh = scrambled(random_mesh(seed), seed, rounds=3)
    steps = 20.0 * np.random.default_rng(seed).standard_normal((mesh.vertex_count, 2))
    kept, rest = collapse_covered(mesh, steps, 0.25)
    assert_valid(kept)
    assert (kept.width, kept.height) == (WIDTH, HEIGHT)
    places = np.searchsorted(mesh.vertex_ids, kept.vertex_ids)
    assert np.array_equal(rest, steps[places])
