"""Drawn pictures: every pixel, exact colours, any size, any style."""

from dataclasses import replace

import numpy as np
import pytest

from stages.edits import split_triangles
from stages.layouts.grid import Grid
from stages.mesh import Mesh, mesh_of
from stages.render import Renderer
from stages.snapshot import Snapshot
from tests.kernel_samples import noise, random_mesh, snapshot_of, waves
from warp_kernels.color_model import CONSTANT, LINEAR, QUADRATIC
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SAMPLES, MAX_SIDE
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.edges import Edges
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient

STALE = 7
"""Colour of what was drawn before."""
SIZES = [(61, 47), (30, 23), (122, 94), (97, 31), (1, 1), (3, 200), (701, 499)]
"""Of the source, half, double, not proportional, tiny, narrow, drawn in several bands [px]."""


def draw(
    snapshot: Snapshot,
    device: str,
    *styles: Style,
    size: tuple[int, int] | None = None,
    threads: int = 0,
) -> np.ndarray:
    """Draw a snapshot over waves, on an output that held another one, [H, W, 3 or 4] uint8."""
    picture = (snapshot.mesh.width, snapshot.mesh.height)
    renderer = Renderer(Device(device, threads), picture, size or picture, styles)
    renderer.render(_stale(snapshot), source=np.full_like(waves(*picture), STALE))
    return renderer.render(snapshot, source=waves(*picture))


def _stale(snapshot: Snapshot) -> Snapshot:
    """What nobody wants to see: more triangles than the next one has, all of one colour."""
    mesh = snapshot.mesh
    finer = split_triangles(mesh, np.flatnonzero(mesh.areas > 0.5 * mesh.areas.max()))
    count = finer.triangle_count
    stale = np.zeros((count, *snapshot.coefficients.shape[1:]))
    stale[:, :, 0] = STALE
    return replace(
        snapshot,
        mesh=finer,
        coefficients=stale,
        energies=np.zeros(count),
        counts=np.ones(count, dtype=np.int64),
        limits=None,
    )


def painted(mesh: Mesh, colors: np.ndarray) -> Snapshot:
    """A snapshot in chosen colours [T, 3]."""
    blank = np.zeros((mesh.height, mesh.width, 3), dtype=np.uint8)
    snapshot = snapshot_of(Device("cpu"), blank, mesh, CONSTANT)
    return replace(snapshot, coefficients=np.asarray(colors, dtype=np.float64)[:, :, None])


def plain(mesh: Mesh, color: tuple[int, int, int]) -> Snapshot:
    """A snapshot in one colour."""
    return painted(mesh, np.tile(color, (mesh.triangle_count, 1)))


def square(side: int) -> Mesh:
    """Two triangles, cut from the upper right to the lower left."""
    points = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    return mesh_of(points, [[0, 1, 3], [1, 2, 3]], side, side)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("color", [(255, 255, 255), (13, 200, 77)])
def test_one_color_is_exact_everywhere(
    color: tuple[int, int, int], size: tuple[int, int], device: str
) -> None:
    """No background, no seam, no rounding: all triangles of one colour give that colour."""
    mesh = random_mesh(61, 47, 80, grid=4)
    for style in (Flat(), Gradient()):
        pixels = draw(plain(mesh, color), device, style, size=size)
        assert pixels.shape == (size[1], size[0], 3)
        assert (pixels == color).all()


def test_very_wide_output_is_drawn_whole(device: str) -> None:
    """Beyond half the largest side there is one sample a pixel; it covers everything too."""
    mesh = random_mesh(61, 47, 80)
    pixels = draw(plain(mesh, (255, 255, 255)), device, Flat(), size=(MAX_SIDE, 3))
    assert (pixels == 255).all()


def test_flat_shows_the_mean_colors(device: str) -> None:
    """Pixels well inside a triangle have the mean of what it covers, rounded."""
    picture, mesh = noise(40, 40), square(40)
    pixels = draw(snapshot_of(Device(device), picture, mesh, CONSTANT), device, Flat())
    y, x = np.mgrid[:40, :40]
    upper = x + y < 39
    lower = x + y >= 39
    assert (pixels[upper] == np.floor(picture[upper].mean(axis=0) + 0.5)).all()
    inside = x + y > 39
    assert (pixels[inside] == np.floor(picture[lower].mean(axis=0) + 0.5)).all()


def test_border_between_two_triangles_is_smooth(device: str) -> None:
    """The diagonal is a mixture of both sides, and everything else is not."""
    pixels = draw(painted(square(32), [(0, 0, 0), (240, 240, 240)]), device, Flat())
    y, x = np.mgrid[:32, :32]
    assert (pixels[x + y < 31] == 0).all()
    assert (pixels[x + y > 31] == 240).all()
    diagonal = pixels[x + y == 31]
    assert (diagonal == diagonal[0]).all()
    assert 80 <= diagonal[0, 0] <= 160


@pytest.mark.parametrize("size", [(61, 47), (122, 94), (40, 80)])
def test_gradient_reproduces_a_linear_picture(size: tuple[int, int], device: str) -> None:
    """A picture that is linear in x and y comes back within one code value, at any size."""
    y, x = np.mgrid[:47, :61]
    source = np.stack([20 + 2 * x + y, 240 - 3 * x, 15 + x + 3 * y], axis=2).astype(np.uint8)
    mesh = Grid().build(source, 40, np.random.default_rng(0))
    snapshot = snapshot_of(Device(device), source, mesh, LINEAR)
    pixels = draw(snapshot, device, Gradient(), size=size).astype(float)
    u = (np.arange(size[0]) + 0.5) * 61 / size[0] - 0.5
    v = ((np.arange(size[1]) + 0.5) * 47 / size[1] - 0.5)[:, None]
    expected = np.stack(np.broadcast_arrays(20 + 2 * u + v, 240 - 3 * u, 15 + u + 3 * v), axis=2)
    assert np.abs(pixels - expected).max() <= 1.0


@pytest.mark.parametrize("size", [(16, 16), (48, 48), (40, 24)])
def test_gradient_reproduces_a_quadratic_picture(size: tuple[int, int], device: str) -> None:
    """A picture that is quadratic in x and y comes back within one code value, at any size."""

    def paint(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """The same function of positions, of pixels and of the output."""
        channels = (x**2 + y, 248 - x * y - y, y**2 + x)
        return np.stack(np.broadcast_arrays(*channels), axis=2)

    source = paint(np.arange(16), np.arange(16)[:, None]).astype(np.uint8)
    snapshot = snapshot_of(Device(device), source, square(16), QUADRATIC)
    pixels = draw(snapshot, device, Gradient(), size=size).astype(float)
    u = (np.arange(size[0]) + 0.5) * 16 / size[0] - 0.5
    v = ((np.arange(size[1]) + 0.5) * 16 / size[1] - 0.5)[:, None]
    assert np.abs(pixels - np.clip(paint(u, v), 0, 255)).max() <= 1.0


def test_flat_shows_the_mean_of_a_quadratic_colour(device: str) -> None:
    """Not its value at the centre, which a bulge raises."""
    y, x = np.mgrid[:40, :40]
    bulge = (250 - ((x - 20) ** 2 + (y - 20) ** 2) / 4).astype(np.uint8)
    picture = np.repeat(bulge[:, :, None], 3, axis=2)
    flat, mean = (
        draw(snapshot_of(Device(device), picture, square(40), model), device, Flat())
        for model in (QUADRATIC, CONSTANT)
    )
    assert np.abs(flat.astype(int) - mean).max() <= 3
    at_centre = draw(
        snapshot_of(Device(device), picture, square(40), QUADRATIC), device, Gradient()
    )
    assert at_centre[13, 13, 0] > flat[13, 13, 0] + 10


def test_colors_beyond_the_range_are_clipped(device: str) -> None:
    """A fit that overshoots is drawn as black or white, not wrapped round."""
    pixels = draw(painted(square(8), [(-40, 300, 1e6), (-1e6, 255.4, 0)]), device, Flat())
    y, x = np.mgrid[:8, :8]
    assert (pixels[x + y < 7] == (0, 255, 255)).all()
    assert (pixels[x + y > 7] == (0, 255, 0)).all()


@pytest.mark.parametrize("zoom", [1, 2])
def test_edges_have_width_color_and_opacity(zoom: int, device: str) -> None:
    """Lines are measured in pixels of the source, centred on their edge."""
    white, side = plain(square(40), (255, 255, 255)), 40 * zoom
    half = draw(white, device, Flat(), Edges(width=4, color="#f00", opacity=0.5), size=(side, side))
    row = half[side // 5]
    np.testing.assert_allclose(row[: 2 * zoom], [(255, 127.5, 127.5)] * 2 * zoom, atol=1)
    assert (row[2 * zoom + 1 : 10 * zoom] == 255).all()
    solid = draw(white, device, Flat(), Edges(width=2, color="#0a141e"), size=(side, side))
    assert (solid[:zoom, side // 5 : side // 2] == (10, 20, 30)).all()
    assert (solid[side // 2, side // 2 - 1] == (10, 20, 30)).all()
    assert (solid[side // 4, side // 4] == 255).all()


def test_wider_lines_cover_more_in_proportion(device: str) -> None:
    """The light that is held back grows with the width, thin lines included."""
    white = plain(square(60), (255, 255, 255))
    widths = (0.25, 0.5, 1.0, 2.0)
    pictures = [draw(white, device, Flat(), Edges(width=w, color="#000")) for w in widths]
    ink = [1.0 - ((picture / 255.0) ** 2).mean() for picture in pictures]
    # half of the border's lines lies outside the picture
    length = 60 * np.sqrt(2) + 4 * 60 / 2
    expected = [length * w / 3600 for w in widths]
    # exact along the axes; on a diagonal a filter across the line is a good third off at most
    np.testing.assert_allclose(ink, expected, rtol=0.16)


def test_opacity_zero_is_invisible(device: str) -> None:
    """Lines that let everything through change nothing."""
    snapshot = snapshot_of(Device(device), waves(60, 40), random_mesh(60, 40, 20), CONSTANT)
    lines = Edges(width=3, opacity=0)
    plain_picture = draw(snapshot, device, Flat())
    np.testing.assert_array_equal(draw(snapshot, device, Flat(), lines), plain_picture)


@pytest.mark.parametrize("size", [(0, 10), (10, 0), (MAX_SIDE + 1, 10)])
def test_impossible_sizes_are_refused(size: tuple[int, int], device: str) -> None:
    """An output without pixels or with too many is an error that names it."""
    with pytest.raises(OptionError, match=f"{size[0]}x{size[1]}"):
        Renderer(Device(device), (10, 10), size, (Flat(),))


def test_growing_meshes_are_drawn(device: str) -> None:
    """One renderer takes a small mesh, one beyond its first memory, and the small one again."""
    small = snapshot_of(Device(device), waves(61, 47), random_mesh(61, 47, 20), CONSTANT)
    large = snapshot_of(Device(device), waves(61, 47), random_mesh(61, 47, 900), CONSTANT)
    renderer = Renderer(Device(device), (61, 47), (61, 47), (Flat(),))
    first = renderer.render(small)
    kept = first.copy()
    np.testing.assert_array_equal(renderer.render(large), draw(large, device, Flat()))
    np.testing.assert_array_equal(renderer.render(small), kept)
    np.testing.assert_array_equal(first, kept)  # a picture handed out is never drawn over


@pytest.mark.parametrize("threads", [2, 3])
def test_no_thread_overtakes_another(threads: int, device: str) -> None:
    """Where the last band is lower, rows change hands: once nobody waited for that."""
    snapshot = snapshot_of(Device(device), waves(96, 64), random_mesh(96, 64, 60), CONSTANT)
    alone = draw(snapshot, device, Flat(), size=(288, 192), threads=1)
    renderer = Renderer(Device(device, threads), (96, 64), (288, 192), (Flat(),))
    for _ in range(40):
        np.testing.assert_array_equal(renderer.render(snapshot), alone)


@pytest.fixture(params=STYLES)
def stack(request: pytest.FixtureRequest) -> tuple[Style, ...]:
    """Give each registered style as people see it: lines over flat colours."""
    style = STYLES[request.param]()
    return (style,) if style.is_opaque else (Flat(), style)


def test_contract_of_a_style(stack: tuple[Style, ...], device: str) -> None:
    """Defaults work; the picture is whole and equal for any number of threads."""
    style = stack[-1]
    assert style == type(style)()
    assert hash(style) == hash(type(style)())
    assert style.degree in (0, 1, 2)
    assert len(style.numbers()) <= 16
    model = LINEAR if style.degree else CONSTANT
    snapshot = snapshot_of(Device(device), waves(61, 47), random_mesh(61, 47, 30), model)
    pictures = [draw(snapshot, device, *stack, size=(75, 33), threads=n) for n in (1, 2, 3)]
    assert pictures[0].shape == (33, 75, 3)
    assert pictures[0].dtype == np.uint8
    assert len(np.unique(pictures[0].reshape(-1, 3), axis=0)) > 10
    for other in pictures[1:]:
        np.testing.assert_array_equal(other, pictures[0])


@pytest.mark.parametrize("size", [(96, 64), (160, 120)])
def test_golden_pictures(
    stack: tuple[Style, ...], size: tuple[int, int], device: str, assert_matches_golden
) -> None:
    """Each style looks as it did when somebody last looked at it."""
    style = stack[-1]
    name = next(key for key, kind in STYLES.items() if isinstance(style, kind))
    model = LINEAR if style.degree else CONSTANT
    snapshot = snapshot_of(Device(device), waves(96, 64), random_mesh(96, 64, 60, seed=8), model)
    pixels = draw(snapshot, device, *stack, size=size)
    assert_matches_golden(pixels, f"{name}_{size[0]}x{size[1]}")


def test_more_samples_bring_borders_nearer_to_how_much_is_covered(device: str) -> None:
    """A slanted border of black and white, whose pixels are known exactly."""
    width, height, slope = 24, 20, 0.37
    ends = np.array([[6.0, 0.0], [6.0 + slope * height, height]])
    points = np.array([[0, 0], *ends[:1], [width, 0], [width, height], *ends[1:], [0, height]])
    triangles = np.array([[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4]])
    snapshot = painted(mesh_of(points, triangles, width, height), np.repeat([0, 255], 2)[:, None])
    fine = np.arange(64 * width) + 0.5
    rows = ends[0, 0] + slope * (np.arange(64 * height) + 0.5) / 64
    covered = (fine / 64 > rows[:, None]).reshape(height, 64, width, 64).mean(axis=(1, 3))
    off = []
    for samples in range(1, MAX_SAMPLES + 1):
        renderer = Renderer(
            Device(device), (width, height), (width, height), (Flat(),), samples=samples
        )
        found = renderer.render(snapshot)[..., 0] / 255
        steps = found * samples**2
        assert np.abs(steps - np.rint(steps)).max() < 0.05
        off.append(float(np.abs(found - covered).mean()))
    assert off == sorted(off, reverse=True)
    assert off[-1] < 0.3 * off[0]
