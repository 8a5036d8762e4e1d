"""Contracts of all styles: they hold still, move with their triangle, blend and name mistakes."""

from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import binary_erosion
from scipy.spatial import Delaunay

from pipeline.options.members import parse_member
from stages.mesh import Mesh, mesh_of
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.validate import assert_valid
from tests.golden_images import write_png
from tests.kernel_samples import random_mesh, waves
from tests.snapshots import snapshot_with
from warp_kernels.color_model import LINEAR
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.color_names import COLOR_NAMES

SIZE = (96, 64)
"""Of the pictures [px]."""
SHIFT = np.array([5, 3])
"""By how much a mesh is moved [px]."""
RIM = 4
"""So far from the border of what moves, its surroundings may show [px]."""


def framed(inner: Mesh, offset: np.ndarray) -> Mesh:
    """A mesh placed inside a larger picture; its triangles come first."""
    width, height = SIZE
    corners = np.array([[0, 0], [width, 0], [0, height], [width, height]])
    points = np.concatenate([inner.vertices + offset, corners])
    rim = np.flatnonzero(inner.on_left_right | inner.on_top_bottom)
    used = np.concatenate([rim, inner.vertex_count + np.arange(4)])
    rows = used[Delaunay(points[used]).simplices]
    outside = [row for row in rows if (row >= inner.vertex_count).any()]
    mesh = mesh_of(points, np.concatenate([inner.triangles, outside]), width, height)
    assert_valid(mesh)
    return mesh


def colored(mesh: Mesh, degree: int, origin: np.ndarray) -> Snapshot:
    """A snapshot in chance colours that are the same seen from an origin [px]."""
    rng = np.random.default_rng(3)
    count = mesh.triangle_count
    means = rng.integers(0, 256, (count, 3)).astype(float)
    if degree == 0:
        return snapshot_with(mesh, means)
    coefficients = np.zeros((count, 3, LINEAR.term_count))
    slopes = rng.integers(-16, 17, (count, 3, 2)) / 4
    coefficients[:, :, LINEAR.term(1, 0)] = slopes[:, :, 0]
    coefficients[:, :, LINEAR.term(0, 1)] = slopes[:, :, 1]
    coefficients[:, :, LINEAR.term(0, 0)] = means - slopes @ np.add(origin, (20, 15))
    return snapshot_with(mesh, coefficients, model=LINEAR)


def draw(
    snapshot: Snapshot, device: str, *styles: Style, zoom: float = 1.0, shift: tuple = (0, 0)
) -> np.ndarray:
    """Draw over a picture that is rolled by a shift [px]."""
    size = (round(SIZE[0] * zoom), round(SIZE[1] * zoom))
    renderer = Renderer(Device(device), SIZE, size, styles)
    source = np.roll(waves(*SIZE), shift[::-1], axis=(0, 1))
    pictures = [renderer.render(snapshot, source=source) for _ in range(2)]
    np.testing.assert_array_equal(*pictures)
    return pictures[0]


@pytest.mark.parametrize("name", STYLES)
@pytest.mark.parametrize("zoom", [1.0, 3.0, 0.5])
def test_style_holds_still_and_moves_with_its_triangle(name: str, zoom: float, device: str) -> None:
    """The same mesh gives the same picture; whole pixels further on the same bits, further on."""
    style = STYLES[name]()
    shift = SHIFT if zoom >= 1 else 2 * SHIFT
    inner = random_mesh(40, 30, 30, grid=256)
    meshes = [framed(inner, np.array([24, 16]) + step) for step in (0 * shift, shift)]
    origins = [np.array([24, 16]), np.array([24, 16]) + shift]
    shots = [colored(m, style.degree, o) for m, o in zip(meshes, origins, strict=True)]
    shown = np.where(np.arange(meshes[0].triangle_count) < inner.triangle_count, 255, 0)
    mask = draw(snapshot_with(meshes[0], np.repeat(shown, 3)), device, STYLES["flat"](), zoom=zoom)
    whole = binary_erosion(mask[..., 0] == 255, iterations=int(RIM * max(zoom, 1)))
    here = draw(shots[0], device, style, zoom=zoom)
    there = draw(shots[1], device, style, zoom=zoom, shift=tuple(shift))
    moved = np.roll(there, -(shift * zoom).astype(int)[::-1], axis=(0, 1))
    np.testing.assert_array_equal(moved[whole], here[whole])
    assert len(np.unique(here[whole], axis=0)) > 20


@pytest.mark.parametrize("name", STYLES)
def test_opacity_mixes_with_what_is_below(name: str, device: str) -> None:
    """At 0 a style is not there, at 1/2 it is half of what it is at 1 over the same ground."""
    style, ground = STYLES[name], STYLES["paper"](color="#fff", grain=0, sheets=0)
    snapshot = colored(random_mesh(*SIZE, 40), style.degree, np.zeros(2))
    none, half, full = (
        draw(snapshot, device, ground, style(opacity=share)).astype(float) for share in (0, 0.5, 1)
    )
    assert (none == 255).all()
    solid = np.full(none.shape[:2], True)
    if not style.covers:
        solid = draw(snapshot, device, style())[..., 3] == 255
    assert np.abs(half - (none + full) / 2)[solid].max() <= 2.0


@pytest.mark.parametrize(
    ("blend", "wanted"),
    [
        ("normal", lambda b, s: s),
        ("multiply", lambda b, s: b * s / 255),
        ("screen", lambda b, s: 255 - (255 - b) * (255 - s) / 255),
        (
            "overlay",
            lambda b, s: np.where(
                b < 127.5, 2 * b * s / 255, 255 - 2 * (255 - b) * (255 - s) / 255
            ),
        ),
    ],
)
def test_blend_modes(blend: str, wanted, device: str) -> None:
    """As W3C's Compositing and Blending defines them, at half opacity."""
    mesh = random_mesh(*SIZE, 40)
    snapshot = colored(mesh, 0, np.zeros(2))
    below = draw(snapshot, device, STYLES["flat"]()).astype(float)
    ink = np.array([40.0, 128.0, 240.0])
    paper = STYLES["paper"](color="#2880f0", grain=0, sheets=0, blend=blend, opacity=0.5)
    pixels = draw(snapshot, device, STYLES["flat"](), paper)
    expected = below + 0.5 * (wanted(below, ink) - below)
    inside = _is_even(below)
    np.testing.assert_allclose(pixels[inside], expected[inside], atol=1.01)


def _is_even(pixels: np.ndarray) -> np.ndarray:
    """Pixels whose neighbours have their colour: no border runs there."""
    even = np.ones(pixels.shape[:2], dtype=bool)
    for axis in (0, 1):
        for step in (-1, 1):
            even &= (np.roll(pixels, step, axis=axis) == pixels).all(axis=2)
    return even


@pytest.mark.parametrize("name", STYLES)
def test_alpha_is_there_where_it_is_needed(name: str, device: str) -> None:
    """A style that leaves holes has alpha; over white it is what it is on white paper."""
    style = STYLES[name]()
    snapshot = colored(random_mesh(*SIZE, 40), style.degree, np.zeros(2))
    alone = draw(snapshot, device, style)
    if style.is_opaque:
        assert alone.shape[2] == 3
        if name == "flat":  # what opacity does to the stack is the same for all
            assert draw(snapshot, device, STYLES[name](opacity=0.5)).shape[2] == 4
        return
    assert alone.shape[2] == 4
    assert alone[..., 3].min() < 128 < alone[..., 3].max()
    white = STYLES["paper"](color="#fff", grain=0, sheets=0)
    on_white = draw(snapshot, device, white, style)
    solid, clear = alone[..., 3] == 255, alone[..., 3] == 0
    np.testing.assert_allclose(alone[solid][:, :3].astype(int), on_white[solid], atol=6)
    assert (on_white[clear] == 255).all()


def test_source_is_the_source(device: str) -> None:
    """Pixel for pixel at its own size, borders of triangles included; means when it is smaller."""
    snapshot = colored(random_mesh(*SIZE, 40), 0, np.zeros(2))
    picture = waves(*SIZE)
    np.testing.assert_array_equal(draw(snapshot, device, STYLES["source"]()), picture)
    small = draw(snapshot, device, STYLES["source"](), zoom=0.5)
    means = picture.reshape(32, 2, 48, 2, 3).mean(axis=(1, 3))
    assert np.abs(small - means).max() <= 0.5


def test_lenses_without_refraction_are_the_source(device: str) -> None:
    """Glass that is as thin as air, or flat, shows the picture; real glass does not."""
    snapshot = colored(random_mesh(*SIZE, 20), 0, np.zeros(2))
    lens, picture = STYLES["lenses"], waves(*SIZE).astype(int)
    for plain in (lens(index=1.0, shine=0.0), lens(height=0.0, shine=0.0)):
        pixels = draw(snapshot, device, plain)
        assert (np.abs(pixels - picture).max(axis=2) <= 1).mean() > 0.6  # borders are averages
    assert (np.abs(draw(snapshot, device, lens()) - picture).max(axis=2) > 8).mean() > 0.1


def test_incircles_fall_off_as_the_paper_says(device: str) -> None:
    """Opacity 1 - (3 r^2 - 2 r^3) along a radius."""
    mesh = mesh_of(np.array([[0, 0], [96, 0], [96, 64], [0, 64]]), [[0, 1, 3], [1, 2, 3]], *SIZE)
    alpha = draw(snapshot_with(mesh, [(9, 9, 9), (9, 9, 9)]), device, STYLES["incircles"](), zoom=3)
    radius = 96 * 64 / (96 + 64 + np.hypot(96, 64))
    row = int(3 * radius)
    away = np.abs((np.arange(288) + 0.5) / 3 - radius) / radius
    away = np.hypot(away, ((row + 0.5) / 3 - radius) / radius)[: int(6 * radius)]
    r = np.minimum(away, 1.0)
    wanted = 255 * (1 - (3 * r**2 - 2 * r**3))
    np.testing.assert_allclose(alpha[row, : len(r), 3].astype(float), wanted, atol=3)


def test_gaps_are_as_wide_as_asked(device: str) -> None:
    """Between shrunk triangles, whatever the size of these."""
    mesh = mesh_of(np.array([[0, 0], [96, 0], [96, 64], [0, 64]]), [[0, 1, 3], [1, 2, 3]], *SIZE)
    snapshot = snapshot_with(mesh, [(9, 9, 9), (9, 9, 9)])
    alpha = draw(snapshot, device, STYLES["shrink"](gap=6), zoom=2)[..., 3] / 255.0
    across = np.hypot(96, 64) / 96  # the diagonal's gap, measured down a column
    np.testing.assert_allclose((1 - alpha[20:108, 96]).sum() / 2, 6 * across, atol=0.3)
    np.testing.assert_allclose((1 - alpha[40, :12]).sum() / 2, 3, atol=0.2)


def test_own_picture_stands_on_the_base_edge(tmp_path: Path, device: str) -> None:
    """Its lower edge along the base, not mirrored: the left half stays left seen from there."""
    mesh = mesh_of(np.array([[0, 0], [96, 0], [96, 64], [0, 64]]), [[2, 3, 1], [0, 1, 3]], *SIZE)
    picture = np.zeros((64, 64, 3), np.uint8)
    picture[:, 32:] = 255
    write_png(tmp_path / "half, white=1.png", picture)
    style = parse_member("--style", f"texture:{tmp_path / 'half, white=1.png'}", STYLES)
    pixels = draw(snapshot_with(mesh, [(128, 128, 128)] * 2), device, style, zoom=2)
    # the first triangle's base runs along the lower border from right to left
    assert pixels[122, 180].min() > 200
    assert pixels[122, 12].max() < 50


@pytest.mark.parametrize(
    ("spec", "named"),
    [
        ("sparkle", "circles"),
        ("circles:gap=-1", "between 0 and 20"),
        ("lenses:index=9", "between 1 and 3"),
        ("paper:colour=#fff", "color"),
        ("paper:color=whit", "white?"),
        ("flat:blend=burn", "normal, multiply, screen, overlay"),
        ("flat:opacity=2", "between 0 and 1"),
        ("texture:no_such.png", "cushion, triangle"),
    ],
)
def test_mistakes_name_what_is_allowed(spec: str, named: str, device: str) -> None:
    """One line with the style, the value and what may be written instead."""
    with pytest.raises(OptionError) as caught:
        Renderer(Device(device), SIZE, SIZE, (parse_member("--style", spec, STYLES),))
    text = str(caught.value)
    assert spec.partition(":")[0] in text
    assert named in text
    assert "\n" not in text


def test_textures_are_sharp_in_flat_triangles(device: str) -> None:
    """As from further away: ten times as wide as high, they were drawn from far too few texels."""
    points = np.array([[0, 0], [240, 0], [240, 24], [0, 24]], dtype=float)
    mesh = mesh_of(points, [[0, 1, 2], [0, 2, 3]], 240, 24)
    snapshot = snapshot_with(mesh, np.full((2, 3), 128.0))
    style = STYLES["texture"](file="triangle")
    near, far = (
        Renderer(Device(device), (240, 24), (240 * zoom, 24 * zoom), (style,)).render(snapshot)
        for zoom in (1, 8)
    )
    from_afar = far.reshape(24, 8, 240, 8, 3).mean(axis=(1, 3))
    assert np.abs(near - from_afar).mean() < 1.2


def test_texture_of_a_thin_triangle_is_its_mean(device: str) -> None:
    """Once it was black: of the coarsest level alone nothing was drawn."""
    points = np.array([[0, 0], [96, 0], [96, 64], [0, 64], [48, 63.5]])
    corners = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    snapshot = snapshot_with(mesh_of(points, corners, *SIZE), [(120, 120, 120)] * 4)
    pixels = draw(snapshot, device, STYLES["texture"](), zoom=2)
    assert pixels[-1, 90:102].min() > 60


@pytest.mark.parametrize(
    ("text", "color"),
    [("white", (255, 255, 255)), ("Dark Orange", (255, 140, 0)), ("#fa0", (255, 170, 0))],
)
def test_colours_have_names(text: str, color: tuple[int, int, int]) -> None:
    """Those of CSS, in any case; none of them could be read as a number."""
    assert parse_color(text) == color
    assert not any(set(name) <= set("0123456789abcdef") for name in COLOR_NAMES)
