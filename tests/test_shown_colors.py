"""A triangle shows only colours that the picture has where it lies."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import maximum_filter, minimum_filter

from pipeline.track import TrackReader, TrackWriter
from pipeline.track.join import join
from stages.edits import collapse_edges, flip_edges
from stages.flows import FLOWS
from stages.flows.passage import Passage
from stages.flows.view import View
from stages.layouts.importance import Importance
from stages.look.fading import Fading
from stages.mesh import Mesh, mesh_of
from stages.motion.advect import advect
from stages.motion.inherit_regions import inherited
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.solve.color_limits import SLACK
from stages.solve.color_owners import color_owners
from stages.solve.grid import shades, value_range
from stages.spaces import SPACES
from stages.topology.appraise import Appraiser
from stages.topology.collapse_slivers import collapse_slivers
from stages.topology.energy import Energy
from stages.topology.followed_slivers import AFFORDED, sliver_changes
from stages.topology.goal import Goal
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from stages.validate import assert_valid
from tests.kernel_samples import frame_of, noise, poisoned_workspace, random_mesh, waves
from tests.meshes import scrambled
from tests.oracles.coverage import covered_pixels, rounded
from tests.tracks import solve_to, write_clip
from warp_kernels.color_model import COLOR_MODELS, CONSTANT, ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.color_bands import Bands
from warp_kernels.energy.color_extremes import Extremes
from warp_kernels.energy.nearby_colors import LEEWAY, Nearby
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.flat import Flat
from warp_kernels.styles.gradient import Gradient

WIDTH, HEIGHT = 16, 12
NEEDLES = (2, 3)
"""Numbers of the triangles of `needles` that cover no pixel's centre."""
MODELS = pytest.mark.parametrize("model", COLOR_MODELS.values(), ids=COLOR_MODELS)
ROUNDING = 1
"""Code values that drawing rounds by."""


def needles() -> Mesh:
    """Two flat triangles across the picture, between the rows of pixels 5 and 6."""
    points = [[0, 0], [16, 0], [16, 12], [0, 12], [0, 6.1], [16, 6.1], [8, 6.4], [8, 5.8]]
    rows = [[0, 1, 7], [0, 7, 4], [4, 7, 5], [4, 5, 6], [1, 5, 7], [4, 6, 3], [6, 5, 2], [6, 2, 3]]
    mesh = mesh_of(np.array(points, dtype=float), np.array(rows), WIDTH, HEIGHT)
    assert_valid(mesh)
    return mesh


def halves() -> np.ndarray:
    """Bright above, middling below: nothing is dark."""
    picture = np.full((HEIGHT, WIDTH, 3), (240, 200, 180), dtype=np.uint8)
    picture[6:] = (90, 120, 110)
    return picture


def style_of(model: ColorModel) -> Style:
    """What shows all of a model's colours."""
    return Gradient() if model.degree else Flat()


def drawn(snapshot: Snapshot, style: Style, device: str, scale: int = 1) -> np.ndarray:
    """A snapshot in one style, code values as int."""
    size = (snapshot.mesh.width, snapshot.mesh.height)
    output = (scale * size[0], scale * size[1])
    return Renderer(Device(device, 2), size, output, (style,)).render(snapshot).astype(int)


def outside(shown: np.ndarray, picture: np.ndarray, side: int) -> np.ndarray:
    """How far drawn pixels leave the range of the source's pixels around them, [H, W]."""
    around = (side, side, 1)
    low, high = minimum_filter(picture, around), maximum_filter(picture, around)
    return np.maximum(low.astype(int) - shown, shown - high.astype(int)).max(axis=2)


@MODELS
@pytest.mark.parametrize("seed", range(2))
def test_extremes_are_those_of_covered_pixels(model: ColorModel, seed: int, device: str) -> None:
    """Against exact coverage, of triangles without a pixel as well."""
    picture, mesh = noise(23, 17, seed), random_mesh(23, 17, 60, seed=seed)
    workspace = poisoned_workspace(Device(device, 2), picture, mesh, model)
    found = Extremes(workspace).measure(mesh.triangle_count)
    for corners, extremes in zip(mesh.corners, found, strict=True):
        _, pixels = covered_pixels([rounded(*corner) for corner in corners], 23, 17)
        below = np.array([picture[y, x] for x, y in pixels]).reshape(-1, 3)
        np.testing.assert_array_equal(extremes[0], below.min(axis=0, initial=255))
        np.testing.assert_array_equal(extremes[1], below.max(axis=0, initial=0))


@MODELS
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("is_weighted", [False, True])
def test_triangles_without_a_pixel_are_not_black(
    model: ColorModel, space: str, is_weighted: bool, device: str
) -> None:
    """They look like what they lie in, however the colours were fitted, and at any size."""
    frame = frame_of(halves())
    if is_weighted:
        weights = np.arange(WIDTH * HEIGHT, dtype=np.uint8).reshape(HEIGHT, WIDTH)
        frame = replace(frame, weights=weights)
    options = TriangulateOptions(color=model.name, space=space)
    triangulator = Triangulator(Device(device, 2), (WIDTH, HEIGHT), options)
    snapshot = triangulator.fit(frame, needles())
    np.testing.assert_array_equal(np.flatnonzero(snapshot.counts == 0), NEEDLES)
    for scale in (1, 4):
        shown = drawn(snapshot, style_of(model), device, scale)
        picture = halves().astype(int)
        assert (shown >= picture.min(axis=(0, 1)) - ROUNDING).all()
        assert (shown <= picture.max(axis=(0, 1)) + ROUNDING).all()


def test_few_pixels_do_not_take_a_large_triangle_along(device: str) -> None:
    """A dark corner of a bright half: all of it would turn dark for a hundredth of its pixels.

    A past bug: a band of the sky turned green for twenty of its thirty thousand pixels.
    """
    picture = np.full((64, 64, 3), 200, dtype=np.uint8)
    picture[:8, :8] = 20
    corners = np.array([[0, 0], [64, 0], [64, 64], [0, 64]], dtype=float)
    mesh = mesh_of(corners, np.array([[0, 1, 2], [0, 2, 3]]), 64, 64)
    triangulator = Triangulator(Device(device, 2), (64, 64), TriangulateOptions())
    snapshot = triangulator.fit(frame_of(picture), mesh)
    assert (snapshot.coefficients > 190).all()
    # all of it has the bright half's own colour, and its error is told
    assert snapshot.rmse == pytest.approx(np.sqrt(np.square(picture - 200.0).mean()), rel=1e-6)


@pytest.mark.parametrize("name", STYLES)
def test_no_style_shows_them_black(name: str, device: str) -> None:
    """Every style draws them as if they had a pixel of their own."""
    snapshot = Triangulator(Device(device, 2), (WIDTH, HEIGHT), TriangulateOptions()).fit(
        frame_of(halves()), needles()
    )
    black = snapshot.coefficients.copy()
    black[list(NEEDLES)] = 0.0
    expected = snapshot.coefficients.copy()
    expected[list(NEEDLES)] = snapshot.coefficients[[1, 5]]
    style = STYLES[name]()
    size = (WIDTH, HEIGHT)
    renderer = Renderer(Device(device, 2), size, (64, 48), (Flat(), style))
    pictures = [
        renderer.render(replace(snapshot, coefficients=c), source=halves())
        for c in (snapshot.coefficients, expected, black)
    ]
    if name == "flat":  # the two ways differ at all
        assert np.abs(pictures[0].astype(int) - pictures[2]).max() > 80
    np.testing.assert_array_equal(pictures[0], pictures[1])


def test_owners_are_neighbours_with_a_colour() -> None:
    """Across the longest side that leads to one; where nothing has a colour all stay as is."""
    mesh = needles()
    counts = np.full(mesh.triangle_count, 9)
    np.testing.assert_array_equal(color_owners(mesh, counts), np.arange(mesh.triangle_count))
    counts[list(NEEDLES)] = 0
    owners = color_owners(mesh, counts)
    assert owners[2] in (1, 4)
    assert owners[3] in (5, 6)
    counts[:] = 0
    counts[7] = 1  # all others, over several rounds
    assert (color_owners(mesh, counts) == 7).all()
    np.testing.assert_array_equal(
        color_owners(mesh, np.zeros_like(counts)), np.arange(mesh.triangle_count)
    )


@MODELS
def test_fading_and_regions_inherit_their_colors(model: ColorModel, device: str) -> None:
    """A needle that is born or dies lets no black through, and goes with what it looks like."""
    options = TriangulateOptions(color=model.name)
    triangulator = Triangulator(Device(device, 2), (WIDTH, HEIGHT), options)
    mesh = needles()
    # without the needles: their apexes have gone along the rows into the border's vertex
    points = mesh.vertices[:6]
    rows = np.array([[0, 1, 5], [0, 5, 4], [4, 5, 3], [5, 2, 3]])
    plain = replace(
        mesh_of(points, rows, WIDTH, HEIGHT),
        triangle_ids=np.arange(20, 24),
        next_vertex_id=mesh.next_vertex_id,
        next_triangle_id=30,
    )
    shots = [triangulator.fit(frame_of(halves(), n), m) for n, m in enumerate((plain, mesh, plain))]
    renderer = Renderer(Device(device, 2), (WIDTH, HEIGHT), (64, 48), (style_of(model),))
    fading = Fading.begin(shots[0], 3)
    for snapshot in shots[1:]:
        fading = fading.followed_by(snapshot)
        shown = renderer.render(snapshot, fading).astype(int)
        assert (shown.min(axis=(0, 1)) >= halves().min(axis=(0, 1)) - ROUNDING).all()
    above = plain.corners[:, :, 1].mean(axis=1) < 6
    members = inherited(shots[0], shots[1], above[:, None])[:, 0]
    np.testing.assert_array_equal(members, shots[1].coefficients[:, 0, 0] > 165)


@pytest.mark.parametrize("color", COLOR_MODELS)
def test_small_triangles_stay_within_what_is_around(color: str, device: str) -> None:
    """No pixel that only triangles of up to 4 x 4 px touch leaves the range of the 9 x 9 around it
    by more than 12: these lie within it. Larger ones may: a mean over a border is such a case."""
    picture = rough_scene()
    snapshot = fitted(picture, color, device)
    owners = color_owners(snapshot.mesh, snapshot.counts)
    corners = np.concatenate([snapshot.mesh.corners, snapshot.mesh.corners[owners]], axis=1)
    is_large = np.ptp(corners, axis=1).max(axis=1) > 4.0
    mask = np.zeros_like(snapshot.coefficients)
    mask[is_large, :, 0] = 255.0
    beside = drawn(replace(snapshot, coefficients=mask, limits=None), Flat(), device).max(axis=2)
    shown = drawn(snapshot, style_of(snapshot.model), device)
    away = outside(shown, picture, 9)
    assert (beside == 0).mean() > 0.1  # what is said here is said of a good part of the picture
    assert away[beside == 0].max() <= SLACK + ROUNDING
    assert (away > 40).mean() < 1e-3  # and of all triangles nearly everywhere


@pytest.mark.parametrize(("width", "height"), [(150, 90), (64, 33), (9, 70), (131, 6)])
def test_bands_let_no_triangle_through(width: int, height: int, device: str) -> None:
    """What they call harmless has no pixel that departs; of plain places nothing is suspected."""
    blocks = np.kron(noise(-(-width // 11), -(-height // 7)), np.ones((7, 11, 1), np.uint8))
    mesh = random_mesh(width, height, 60, seed=width)
    for picture in (blocks[:height, :width].copy(), noise(width, height), waves(width, height)):
        workspace = poisoned_workspace(Device(device), picture, mesh, CONSTANT)
        coefficients, energies, _ = workspace.fit()
        limits = np.broadcast_to(np.uint8([[0], [255]]), (mesh.triangle_count, 2, 3))
        bands, nearby = Bands(workspace), Nearby(workspace)
        for shift in (0.0, 60.0, -110.0):
            colors = np.clip(coefficients + shift, 0.0, 255.0)
            told = np.where(energies > 0, 1e300, 0.0)
            departing = nearby.measure(colors, told, limits).counts > 0
            suspects = bands.suspects(colors, told)
            assert not (departing & ~suspects).any()
            assert suspects.sum() <= departing.sum() + 0.3 * mesh.triangle_count


@pytest.mark.parametrize("color", COLOR_MODELS)
@pytest.mark.parametrize("is_weighted", [False, True])
def test_borders_show_no_third_colour(color: str, is_weighted: bool, device: str) -> None:
    """Past bug: the mean of a large triangle over a strong border was seen deep on one side of it.

    What is told of the error stays true, and threads change nothing.
    """
    picture = np.full((48, 64, 3), (40, 60, 90), dtype=np.uint8)
    picture[:, 10:] = (180, 170, 100)
    picture += waves(64, 48) // 16
    weights = np.arange(48 * 64).reshape(48, 64) % 251 + 1 if is_weighted else None
    frame = replace(frame_of(picture), weights=None if weights is None else weights.astype("u1"))
    corners = np.array([[0, 0], [64, 0], [64, 48], [0, 48]], dtype=float)
    mesh = mesh_of(corners, np.array([[0, 1, 2], [0, 2, 3]]), 64, 48)
    options = TriangulateOptions(color)
    shots = []
    for threads in (1, 3):
        triangulator = Triangulator(Device(device, threads), (64, 48), options)
        shots.append(triangulator.fit(frame, mesh))
    snapshot = shots[0]
    np.testing.assert_array_equal(snapshot.coefficients, shots[1].coefficients)
    np.testing.assert_array_equal(snapshot.energies, shots[1].energies)
    workspace = poisoned_workspace(Device(device, 2), picture, mesh, snapshot.model)
    coefficients, energies, _ = workspace.fit()
    best = replace(snapshot, coefficients=coefficients, energies=energies)
    away = [
        (outside(drawn(s, style_of(s.model), device), picture, 9) > LEEWAY + ROUNDING).sum()
        for s in (best, snapshot)
    ]
    assert away[0] > 0
    assert away[1] < away[0]
    assert (snapshot.energies >= energies * (1 - 1e-5) - 1e-6).all()
    shown = drawn(replace(snapshot, limits=None), style_of(snapshot.model), device)
    told = np.sqrt(np.square(shown - picture.astype(float)).mean())
    assert snapshot.rmse == pytest.approx(told, rel=0.02)


@cache
def rough_scene() -> np.ndarray:
    """Waves, a bright disc, and fine noise in a corner."""
    picture = waves(80, 60)
    picture[35:, 45:] = noise(35, 25)
    return picture


def fitted(picture: np.ndarray, color: str, device: str) -> Snapshot:
    """A picture in so many triangles that most are small."""
    options = TriangulateOptions(color, iterations=24, refine=RefineOptions(triangles=1500))
    size = (picture.shape[1], picture.shape[0])
    triangulator = Triangulator(Device(device, 2), size, options)
    return triangulator.first(frame_of(picture), Importance(), np.random.default_rng(5))


@pytest.mark.parametrize("model", [m for m in COLOR_MODELS.values() if m.degree])
def test_polynomials_stay_within_their_pixels(model: ColorModel, device: str) -> None:
    """With few pixels or many, nearly singular or not; and what is drawn has no larger error."""
    picture = noise(40, 30)
    mesh = random_mesh(40, 30, 120, seed=3)
    triangulator = Triangulator(Device(device, 2), (40, 30), TriangulateOptions(color=model.name))
    snapshot = triangulator.fit(frame_of(picture), mesh)
    extremes = Extremes(poisoned_workspace(Device(device, 2), picture, mesh, model)).measure(
        mesh.triangle_count
    )
    covering = snapshot.counts > 0
    limits = snapshot.limits[covering].astype(int)
    assert (limits[:, 0] >= extremes[covering, 0].astype(int) - SLACK).all()
    assert (limits[:, 1] <= extremes[covering, 1].astype(int) + SLACK).all()
    # no pixel's colour is out of bounds, unless the polynomial does not reach it anyway
    values = shades(mesh, model, snapshot.coefficients)
    lowest, highest = (bound.T[covering] for bound in value_range(values))
    assert (limits[:, 0] <= np.maximum(extremes[covering, 0], lowest)).all()
    assert (limits[:, 1] >= np.minimum(extremes[covering, 1], highest)).all()
    errors = [
        np.square(drawn(s, Gradient(), device) - picture.astype(int)).mean()
        for s in (snapshot, replace(snapshot, limits=None))
    ]
    assert errors[0] < errors[1]
    assert np.sqrt(errors[0]) < snapshot.rmse + 40  # mixed borders of noise, not the fit


def test_even_slopes_are_not_limited(device: str) -> None:
    """A picture that changes evenly is drawn as without limits, but for a few tips' last pixels."""
    x = np.arange(48)[None, :, None] + np.arange(36)[:, None, None]
    picture = np.broadcast_to(40 + 2 * x, (36, 48, 3)).astype(np.uint8)
    triangulator = Triangulator(Device(device, 2), (48, 36), TriangulateOptions(color="linear"))
    snapshot = triangulator.fit(frame_of(picture), random_mesh(48, 36, 6, seed=2))
    pictures = [drawn(s, Gradient(), device, 3) for s in (snapshot, replace(snapshot, limits=None))]
    changes = np.abs(pictures[0] - pictures[1])
    assert changes.max() <= 4
    assert (changes > 0).mean() < 0.003


@cache
def discs() -> list[np.ndarray]:
    """Two discs that pass over a plain table with a slope at its front, with a little grain."""
    rng = np.random.default_rng(3)
    y, x = np.mgrid[:90, :128] + 0.5
    frames = []
    for k in range(6):
        table = np.where(y > 60, 112 - (y - 60), 112.0)
        picture = np.repeat(table[:, :, None], 3, axis=2)
        for centre, radius in (((40 + 1.7 * k, 30 + 0.6 * k), 12), ((85 - 1.2 * k, 44 - k), 9)):
            inside = np.clip(radius - np.hypot(x - centre[0], y - centre[1]) + 0.5, 0, 1)
            picture += inside[:, :, None] * (np.array([56, 184, 56]) - picture)
        grain = rng.normal(0, 1.2, picture.shape)
        frames.append(np.clip(picture + grain, 0, 255).astype(np.uint8))
    return frames


@cache
def followed_discs(device: str) -> list[Snapshot]:
    """The discs, in more triangles than they need."""
    options = TriangulateOptions(
        iterations=48, frame_iterations=12, refine=RefineOptions(triangles=600)
    )
    triangulator = Triangulator(Device(device, 2), (128, 90), options)
    frames = [frame_of(picture, k) for k, picture in enumerate(discs())]
    shot = [triangulator.first(frames[0], Importance(), np.random.default_rng(0))]
    for before, frame in pairwise(frames):
        passage = Passage.between(FLOWS["dis"](), View(before.pixels), View(frame.pixels))
        shot.append(triangulator.next(frame, advect(shot[-1].mesh, passage)))
    return shot


def test_no_specks_on_flat_graphics(device: str) -> None:
    """Past bug: slivers between the pixels were drawn black, in every frame of such a clip."""
    shot = followed_discs(device)
    assert sum(int((s.counts == 0).sum()) for s in shot) > 0
    away, black = 0, 0
    for snapshot, picture in zip(shot, discs(), strict=True):
        colors = np.where(snapshot.counts[:, None, None] == 0, 0.0, snapshot.coefficients)
        found = [
            int((outside(drawn(s, Flat(), device), picture, 7) > 12).sum())
            for s in (snapshot, replace(snapshot, coefficients=colors))
        ]
        away, black = max(away, found[0]), black + found[1]
    assert away <= 2
    assert black > 0  # or nothing was tested


def test_nothing_flashes_where_the_picture_rests(device: str) -> None:
    """No pixel is another colour for one frame alone while the source does not change there."""
    shown = [drawn(snapshot, Flat(), device) for snapshot in followed_discs(device)]
    pictures = [picture.astype(int) for picture in discs()]
    for k in range(1, len(shown) - 1):
        changes = np.stack([shown[k] - shown[k - 1], shown[k] - shown[k + 1]])
        flashes = (changes > 24).all(axis=0) | (changes < -24).all(axis=0)
        rests = [np.abs(pictures[k] - pictures[other]).max(axis=2) < 6 for other in (k - 1, k + 1)]
        assert (flashes.any(axis=2) & rests[0] & rests[1]).sum() <= 1


@pytest.mark.parametrize("seed", range(3))
def test_slivers_go_only_where_that_is_cheap(seed: int, device: str) -> None:
    """Past bug: a needle collapsed across an outline, and its colour shot into what lay beside."""
    picture = waves(61, 47)
    mesh = scrambled(random_mesh(61, 47, 90, seed=seed), seed, rounds=2)
    workspace = poisoned_workspace(Device(device, 2), picture, mesh, CONSTANT)
    appraiser = Appraiser(workspace, 0.5)
    before = appraiser.energies(mesh)
    free = np.ones(mesh.triangle_count, dtype=bool)
    going, turned = sliver_changes(mesh, appraiser, 1.0, np.inf, free)
    assert len(going)
    assert not free[going // 3].any()
    mended = collapse_edges(flip_edges(mesh, turned), going)
    assert_valid(mended)
    assert (mended.heights < 1.0).sum() < (mesh.heights < 1.0).sum()
    most = AFFORDED * (len(going) + len(turned)) * before.mean()
    assert appraiser.energies(mended).sum() <= before.sum() + most
    carelessly = collapse_slivers(mesh, 1.0)
    assert appraiser.energies(mended).sum() < appraiser.energies(carelessly).sum()


def test_triangles_without_a_pixel_are_spent_elsewhere(device: str) -> None:
    """In a followed picture they go, for they are not missed; neighbours one after the other."""
    mesh = needles()
    workspace = poisoned_workspace(Device(device, 2), halves(), mesh, CONSTANT)
    appraiser = Appraiser(workspace, 0.5)
    goal = Goal(mesh.triangle_count, calm=True)
    for _ in NEEDLES:
        mesh = Energy().adapt(mesh, appraiser, goal)
    appraiser.energies(mesh)
    assert (appraiser.counts > 0).all()


def test_tracks_keep_the_limits(tmp_path: Path) -> None:
    """To the bit; tracks of earlier programs have none, are read, gone on with and joined."""
    clip = write_clip(tmp_path / "in.mp4")
    options = {
        "triangulate": TriangulateOptions(
            "linear", iterations=8, frame_iterations=4, refine=RefineOptions(triangles=40)
        )
    }
    whole, old, rest = (tmp_path / f"{name}.mtrk" for name in ("whole", "old", "rest"))
    solve_to(whole, clip, "0-7", **options)
    with TrackReader(whole) as track:
        expected = [track.snapshot(k) for k in range(8)]
    assert all(s.limits.shape == (s.mesh.triangle_count, 2, 3) for s in expected)
    solve_to(old, clip, "0-3", **options)
    with closing(sqlite3.connect(old)) as connection, connection:
        connection.execute("DROP TABLE limits")
    with TrackReader(old) as track:
        assert track.snapshot(3).limits is None
    joined = tmp_path / "joined.mtrk"
    shutil.copy(old, joined)
    solve_to(joined, clip, "0-7", resume=True, **options)
    solve_to(rest, clip, "4-7", **options)
    mixed = tmp_path / "mixed.mtrk"
    join([old, rest], mixed)
    for path in (joined, mixed):
        with TrackReader(path) as track:
            assert track.snapshot(3).limits is None
            assert track.snapshot(7).limits.dtype == np.uint8
    with TrackReader(joined) as track:
        np.testing.assert_array_equal(track.snapshot(7).limits, expected[7].limits)


def test_black_needles_of_old_tracks_are_mended(tmp_path: Path) -> None:
    """Those of earlier programs hold zeros where a triangle covers no pixel."""
    path = tmp_path / "old.mtrk"
    solve_to(path, write_clip(tmp_path / "in.mp4"), "0-0")
    with TrackReader(path) as track:
        snapshot, header = track.snapshot(0), track.header
    needle = int(np.argmin(snapshot.mesh.heights))
    colors, counts = snapshot.coefficients.copy(), snapshot.counts.copy()
    colors[needle], counts[needle] = 0.0, 0
    other = tmp_path / "other.mtrk"
    with TrackWriter(other, header) as writer:
        writer.write(replace(snapshot, coefficients=colors, counts=counts), 0)
    with TrackReader(other) as track:
        found = track.snapshot(0).coefficients
    owner = color_owners(snapshot.mesh, counts)[needle]
    assert owner != needle
    np.testing.assert_array_equal(found[needle], colors[owner])
