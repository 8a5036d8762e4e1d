"""Triangles that are drawn larger than coordinates reach are cut into pieces, without a gap."""

import numpy as np

from warp_kernels.drawing.pieces import within_reach

PICTURE = (640, 360)
REACH = 2_000.0


def inside(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Which places lie in which triangles, [places, triangles]."""
    a, b, c = (corners[None, :, k] for k in range(3))
    p = places[:, None]

    def side(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        along, to = other - one, p - one
        return along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0] > 0

    first, second, third = side(a, b), side(b, c), side(c, a)
    return (first == second) & (second == third)


def test_pieces_cover_what_their_triangle_does() -> None:
    """Every place of the picture lies in one piece of each triangle that holds it."""
    rng = np.random.default_rng(3)
    corners = rng.uniform(-9_000, 9_000, (40, 3, 2))
    places = rng.uniform((0, 0), PICTURE, (500, 2))
    numbers, pieces = within_reach(corners, PICTURE, REACH)
    assert (pieces > -REACH).all()
    assert (pieces < np.array(PICTURE) + REACH).all()
    assert len(pieces) > len(corners)
    held = inside(pieces, places).astype(int)
    counts = np.stack([held[:, numbers == k].sum(axis=1) for k in range(40)], axis=1)
    assert np.array_equal(counts, inside(corners, places))


def test_what_is_within_reach_is_left_as_it_is() -> None:
    """And what the picture does not show is left out."""
    near = np.array([[[0.0, 0.0], [90.0, 5.0], [40.0, 70.0]]])
    numbers, pieces = within_reach(np.concatenate([near - 500, near, near + 9]), PICTURE, REACH)
    assert numbers.tolist() == [1, 2]
    assert np.array_equal(pieces, np.concatenate([near, near + 9]))
