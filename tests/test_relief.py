"""Heights in 3D formats: brightness or a picture of depth, without cracks."""

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stages.exchange import format_of
from stages.exchange.relief import Relief
from stages.exchange.solids.corners import corners_of, vertex_places
from stages.exchange.solids.heights import means_around, sampled
from tests.films import figures_of, film_of
from tests.meshes import HEIGHT, WIDTH, random_mesh, two_triangles
from tests.snapshots import snapshot_with
from warp_kernels.errors import MediaError, OptionError


def test_grey_lies_at_its_brightness_and_corners_meet() -> None:
    mesh = random_mesh(2)
    grey = np.full((mesh.triangle_count, 3), 51)
    (even,) = figures_of([snapshot_with(mesh, grey)])
    heights = vertex_places(even, film_of(".glb", relief="0.5"))[:, 2]
    np.testing.assert_allclose(heights, 0.2 * 0.5 * WIDTH, rtol=1e-6)
    down = vertex_places(even, film_of(".glb", relief="-0.5"))[:, 2]
    np.testing.assert_allclose(down, 0.8 * 0.5 * WIDTH, rtol=1e-6)
    loud = np.random.default_rng(1).integers(0, 256, (mesh.triangle_count, 3))
    (figure,) = figures_of([snapshot_with(mesh, loud)])
    film = film_of(".ply", relief="0.5")
    corners = corners_of(figure, film).points
    places = vertex_places(figure, film)
    np.testing.assert_array_equal(corners, places[mesh.triangles[:, [0, 2, 1]]])
    assert 0 <= places[:, 2].min() < places[:, 2].max() <= 0.5 * WIDTH


def test_triangles_count_by_their_angles() -> None:
    values = np.repeat([[0.0], [1.0]], 3, axis=1)
    mesh = two_triangles()
    corner, shared = mesh.triangles[0][0], mesh.triangles[0][1]
    means = means_around(mesh, values)
    assert means[corner] == 0
    assert means[shared] == pytest.approx(0.5)


def test_a_picture_of_depth_is_stretched_over_the_frame(tmp_path: Path) -> None:
    ramp = np.tile(np.arange(0, 256, 5, dtype=np.uint8), (4, 1))
    Image.fromarray(ramp).save(tmp_path / "depth.png")
    mesh = random_mesh(2)
    (figure,) = figures_of([snapshot_with(mesh, np.zeros((mesh.triangle_count, 3)))])
    film = film_of(".obj", relief=f"1:{tmp_path / 'depth.png'}")
    places = vertex_places(figure, film)
    inner = (places[:, 0] > 2) & (places[:, 0] < WIDTH - 2)
    share = (places[inner, 0] / WIDTH * ramp.shape[1] - 0.5) * 5 / 255
    np.testing.assert_allclose(places[inner, 2], share * WIDTH, atol=0.02 * WIDTH)
    assert sampled(np.array([[0.0, 1.0]]), np.array([[0.5, 0.3]])) == [0.5]
    assert HEIGHT < WIDTH


@pytest.mark.parametrize("text", ["x", "0", "nan", "-inf", "11", ""])
def test_other_heights_are_refused(text: str) -> None:
    with pytest.raises(OptionError, match=f"--relief {re.escape(text)}: write a height"):
        Relief.parse(text)


def test_flat_formats_and_missing_pictures_are_refused_at_once(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"--relief: means nothing in .svg, only in .glb"):
        format_of("a.svg").check(film_of(".svg", relief="1"))
    with pytest.raises(MediaError, match="no such file"):
        format_of("a.glb").check(film_of(".glb", relief=f"1:{tmp_path / 'no.png'}"))
