"""Hatching: tone, colour, direction and distance of the strokes on triangles."""

from dataclasses import replace

import numpy as np
import pytest

from stages.edits import flip_edges, turn_base_edge
from stages.look.fading import Fading
from stages.mesh import Mesh, mesh_of
from stages.render import Renderer
from tests.snapshots import snapshot_with
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.styles.crosshatching import Crosshatching
from warp_kernels.styles.drawn import Drawn
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.hatching import Hatching
from warp_kernels.styles.tones.lookup import PAIRS, packed_tones, softened
from warp_kernels.styles.tones.tonal_art_map import DARKEST

KINDS = (Hatching, Crosshatching)
BLACK_ON_WHITE = {"ink": "#000", "paper": "#fff"}
PEN = {"paper": "#f8f4ea"}
"""Ink on a sheet."""
WIDTH, HEIGHT = 240, 180
"""Of the picture [px]."""
DIRECTIONS = {0.0, 90.0, 36.87}
"""Of the sides of both triangles [degrees]."""


def two_triangles(first_id: int = 0) -> Mesh:
    """A picture cut from the upper left to the lower right."""
    points = np.array([[0, 0], [WIDTH, 0], [WIDTH, HEIGHT], [0, HEIGHT]], dtype=float)
    mesh = mesh_of(points, [[0, 1, 2], [0, 2, 3]], WIDTH, HEIGHT)
    return replace(mesh, triangle_ids=first_id + np.arange(2))


def draw(mesh: Mesh, color: float | tuple, device: str, style: Drawn, zoom: float = 1.0):
    """Draw triangles of one colour or grey, [rows, columns, 3] float."""
    snapshot = snapshot_with(mesh, np.full((mesh.triangle_count, 3), color, dtype=float))
    size = (round(mesh.width * zoom), round(mesh.height * zoom))
    renderer = Renderer(Device(device), (mesh.width, mesh.height), size, (style,))
    return renderer.render(snapshot).astype(float)


def light(pixels: np.ndarray) -> np.ndarray:
    """Mean light of each channel, 0 to 1."""
    return ((pixels / 255.0) ** 2).mean(axis=(0, 1))


def direction(pixels: np.ndarray) -> float:
    """Direction of the strokes [degrees from the right to below, 0 to 180]."""
    down, right = np.gradient(pixels[..., 0])
    angle = np.arctan2(2 * (down * right).sum(), (right**2 - down**2).sum()) / 2
    return float((np.degrees(angle) + 90.0) % 180.0)


def upper_right(pixels: np.ndarray) -> np.ndarray:
    """A part of the first triangle, away from its borders; at twice its size."""
    return pixels[20:160, 260:460]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("zoom", [0.25, 1.0, 3.0])
def test_tone_is_the_brightness_at_every_scale(kind: type[Drawn], zoom: float, device: str) -> None:
    """As much ink as the triangle is dark, up to the darkest tone, however large the output."""
    style = kind(spacing=2.0, lighten=0.0, **BLACK_ON_WHITE)
    for value in (255, 200, 128, 60, 0):
        ink = 1.0 - light(draw(two_triangles(), value, device, style, zoom))
        np.testing.assert_allclose(ink, min(DARKEST, 1.0 - value / 255.0), atol=0.02)


@pytest.mark.parametrize("color", [(200, 120, 60), (90, 140, 200), (230, 220, 120), (30, 30, 30)])
def test_coloured_pencils_give_the_colour_of_the_triangle(color: tuple, device: str) -> None:
    """From afar, where light mixes, strokes and paper are the colour that was approximated."""
    style = Hatching(spacing=2.0, colored=1.0)
    mixed = 255.0 * np.sqrt(light(draw(two_triangles(), color, device, style)))
    np.testing.assert_allclose(mixed, color, atol=6.0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("color", [(200, 120, 60), (90, 140, 200), (30, 40, 30), (140, 140, 140)])
def test_strokes_on_its_own_colour_keep_it(kind: type[Drawn], color: tuple, device: str) -> None:
    """What they take away the paper between them gets, at any contrast; at 0 nothing is seen."""
    spread = []
    for contrast in (0.0, 0.5, 1.0):
        style = kind(spacing=2.0, contrast=contrast)
        pixels = draw(two_triangles(), color, device, style, 2.0)
        np.testing.assert_allclose(255.0 * np.sqrt(light(pixels)), color, atol=3.0)
        spread.append(pixels.std(axis=(0, 1)).max() / max(color))
    assert spread[0] < 0.01
    assert 0.03 < spread[1] < 0.7 * spread[2]


def test_paper_of_its_own_colour_is_no_brighter_than_white(device: str) -> None:
    """Where a channel cannot be raised strokes still show; they darken it a little."""
    pixels = draw(two_triangles(), (255, 40, 20), device, Hatching(), 2.0)
    assert pixels[..., 0].max() == 255.0
    assert 170.0 < pixels[..., 0].min() < 190.0
    assert draw(two_triangles(), 255, device, Hatching()).min() == 255.0


@pytest.mark.parametrize("kind", KINDS)
def test_strokes_fade_in(kind: type[Drawn], device: str) -> None:
    """A triangle that darkens a little changes a little everywhere: no stroke pops up."""
    style = kind(lighten=0.0, **BLACK_ON_WHITE)
    values = np.linspace(40, 250, 12)
    for value in values:
        before, after = (draw(two_triangles(), v, device, style) for v in (value, value - 1.0))
        change = (before / 255.0) ** 2 - (after / 255.0) ** 2
        assert change.max() <= 0.05
        assert change.min() >= -0.01


@pytest.mark.parametrize("kind", KINDS)
def test_strokes_without_paper_lie_on_what_is_below(kind: type[Drawn], device: str) -> None:
    """Over flat colours they look as on paper of that colour; over nothing there is alpha."""
    snapshot = snapshot_with(two_triangles(), np.tile((90, 160, 200), (2, 1)))
    alone, on_paper = kind(paper="none"), kind(paper="#5aa0c8")
    stacks = ((Flat(), alone), (on_paper,), (alone,))
    over, paper, bare = (
        Renderer(Device(device), (WIDTH, HEIGHT), (WIDTH, HEIGHT), stack).render(snapshot)
        for stack in stacks
    )
    np.testing.assert_allclose(over.astype(int), paper, atol=2)
    assert over.std() > 20
    assert bare.shape[2] == 4
    assert set(np.unique(bare[..., 3])) >= {0, 128, 200}


@pytest.mark.parametrize("first_id", [0, 1, 2, 5])
def test_strokes_follow_the_base_edge(first_id: int, device: str) -> None:
    """They lie along a side; turning the base edge goes through all sides and back."""
    mesh, style = two_triangles(first_id), Hatching(spacing=6.0, **PEN)
    found = []
    for _ in range(3):
        found.append(direction(upper_right(draw(mesh, 140, device, style, 2.0))))
        mesh = turn_base_edge(mesh, np.array([0]))
    nearest = [min(DIRECTIONS, key=lambda d: abs((a - d + 90) % 180 - 90)) for a in found]
    assert set(nearest) == DIRECTIONS
    for angle, side in zip(found, nearest, strict=True):
        assert abs((angle - side + 90) % 180 - 90) < 3.0


@pytest.mark.parametrize("first_id", [0, 1, 2, 3])
def test_strokes_run_along_needles(first_id: int, device: str) -> None:
    """Whichever of its sides is the base: across it they would be a row of ticks."""
    points = np.array([[0, 0], [WIDTH, 0], [WIDTH, 40], [0, 40]], dtype=float)
    mesh = mesh_of(points, [[0, 1, 2], [0, 2, 3]], WIDTH, 40)
    mesh = replace(mesh, triangle_ids=first_id + np.arange(2))
    for _ in range(3):
        pixels = draw(mesh, 140, device, Hatching(spacing=6.0, **PEN), 2.0)
        angle = direction(pixels[4:24, 200:440])
        assert abs((angle + 90) % 180 - 90) < 12.0
        mesh = turn_base_edge(mesh, np.array([0, 1]))


def test_angle_turns_the_strokes(device: str) -> None:
    """From the base edge, clockwise on the screen."""
    styles = (Hatching(spacing=6.0, angle=angle, **PEN) for angle in (0.0, 25.0))
    pictures = (draw(two_triangles(), 140, device, style, 2.0) for style in styles)
    straight, turned = (direction(upper_right(pixels)) for pixels in pictures)
    assert abs((turned - straight) % 180 - 25.0) < 3.0


@pytest.mark.parametrize("spacing", [5.0, 9.0])
def test_lines_have_their_distance(spacing: float, device: str) -> None:
    """In pixels of the picture."""
    style = Hatching(spacing=spacing, **PEN)
    pixels = upper_right(draw(two_triangles(), 120, device, style, 2.0))[..., 0]
    spectrum = np.abs(np.fft.fft2(pixels - pixels.mean(), s=(512, 512)))
    waves = np.unravel_index(spectrum.argmax(), spectrum.shape)
    turns = np.hypot(*((wave + 256) % 512 - 256 for wave in waves))
    assert 512 / turns == pytest.approx(2.0 * spacing, rel=0.12)


def test_each_triangle_has_strokes_of_its_own(device: str) -> None:
    """They belong to its number, not to its shape or place; the seed chooses others."""
    pictures = [
        draw(two_triangles(first_id), 140, device, Hatching(seed=seed, **PEN))
        for first_id, seed in ((4, 0), (4, 0), (7, 0), (4, 9))
    ]
    np.testing.assert_array_equal(pictures[0], pictures[1])
    for other in pictures[2:]:
        assert np.abs(other - pictures[0]).mean() > 30


def test_strokes_fade_with_births_and_deaths(device: str) -> None:
    """Where triangles replace others their strokes come as slowly as their colours."""
    mesh = two_triangles()
    color = np.full((2, 3), 120.0)
    before = snapshot_with(mesh, color)
    diagonal = np.flatnonzero(mesh.twins >= 0)[:1]
    after = snapshot_with(flip_edges(mesh, diagonal), color, index=1)
    fading = Fading.begin(before, 8).followed_by(after)
    renderer = Renderer(Device(device), (WIDTH, HEIGHT), (WIDTH, HEIGHT), (Hatching(),))
    old, new = (renderer.render(snapshot).astype(float) for snapshot in (before, after))
    mixed = renderer.render(after, fading).astype(float)
    assert 0.0 < np.abs(mixed - old).mean() < 0.3 * np.abs(new - old).mean()


def test_packed_tones_are_where_shaders_look() -> None:
    """Each texel with those to the right and below, in a tone and the next darker one, softened."""
    rng = np.random.default_rng(1)
    tones = np.sort(rng.random((PAIRS + 1, 512, 512), dtype=np.float32), axis=0)[::-1]
    blocks = packed_tones(tones).levels[1].reshape(PAIRS, 128, 64, 2, 4, 8)
    level = blocks.swapaxes(2, 3).reshape(PAIRS, 256, 256, 2, 2, 2)
    half = 255.0 * tones.reshape(PAIRS + 1, 256, 2, 256, 2).mean(axis=(2, 4))
    half = softened(np.rint(half).astype(np.uint8)).astype(float)
    for below, right, darker in np.ndindex(2, 2, 2):
        wanted = np.roll(half, (-below, -right), axis=(1, 2))[darker : darker + PAIRS]
        assert np.abs(level[..., below, right, darker] - wanted).max() <= 0.51


@pytest.mark.parametrize(
    ("parameter", "value"),
    [("spacing", 0.5), ("weight", 0.9), ("colored", 1.5), ("seed", -1), ("paper", "bluish")],
)
def test_values_out_of_range_are_named(parameter: str, value: object) -> None:
    """One line that names the value."""
    with pytest.raises(OptionError, match=str(value)):
        Hatching(**{parameter: value})
