"""Moves of triangles: at rest they change no bit; what is drawn elsewhere is drawn the same."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.options.members import parameters, parse_member
from stages.mesh import Mesh
from stages.moves import MOVES
from stages.moves.pose import Pose, Resting
from stages.moves.staged import check_moment, moved_by
from stages.render import Renderer
from stages.snapshot import Snapshot
from tests.kernel_samples import random_mesh, waves
from tests.snapshots import snapshot_with
from warp_kernels.device.device import Device
from warp_kernels.drawing.moved import Moved
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.backcloth import Backcloth

SIZE = (96, 64)
"""Of the pictures [px]."""
STACKS = {
    "colours": ("flat",),
    "ink": ("gradient", "edges:width=2", "hatching:paper=none"),
    "picture": ("source", "texture"),
}
"""Stacks whose parts stick to their triangles in different ways."""
FIRM = ("jitter", "wave")
"""Moves that keep triangles together and the border of the picture where it is."""


def mesh_of_chance() -> Mesh:
    """A mesh of the size of the pictures."""
    return random_mesh(*SIZE, 30, seed=7)


def colored(mesh: Mesh) -> Snapshot:
    """Chance colours."""
    colors = np.random.default_rng(3).integers(0, 256, (mesh.triangle_count, 3))
    return snapshot_with(mesh, colors, index=4)


def stack_of(name: str) -> tuple[Style, ...]:
    """Styles by the names of `STACKS`."""
    return tuple(parse_member("--style", spec, STYLES) for spec in STACKS[name])


def resting_of(mesh: Mesh, time: float = 0.4) -> Resting:
    """What moves look at."""
    colors = np.random.default_rng(3).integers(0, 256, (mesh.triangle_count, 3))
    ids = mesh.vertex_ids[mesh.triangles]
    return Resting(mesh.corners, mesh.triangle_ids, ids, colors, SIZE, time, 4)


def at_rest(mesh: Mesh) -> Moved:
    """Every triangle where it lies."""
    return Pose.at_rest(resting_of(mesh)).drawn


def drawn(
    device: str,
    snapshot: Snapshot,
    styles: tuple[Style, ...],
    moved: Moved | None = None,
    ground: np.ndarray | None = None,
) -> np.ndarray:
    """A snapshot where its triangles lie, or where they are moved to."""
    renderer = Renderer(Device(device), SIZE, SIZE, styles, moves=moved is not None)
    return renderer.render(snapshot, source=waves(*SIZE), moved=moved, ground=ground)


@pytest.mark.parametrize("name", MOVES)
def test_nothing_moves_at_rest(name: str) -> None:
    """At amount 0 no triangle is drawn elsewhere: frames are those without moves."""
    mesh = mesh_of_chance()
    for time in (0.0, 0.7):
        assert moved_by([MOVES[name](amount=0.0)], colored(mesh), time) is None
    moved = moved_by([MOVES[name](amount=0.5)], colored(mesh), 0.7)
    assert moved is not None
    assert not np.array_equal(moved.corners, mesh.corners)


@pytest.mark.parametrize("stack", STACKS)
def test_what_comes_to_rest_is_drawn_as_what_rests(stack: str, device: str) -> None:
    """So a move begins and ends without a jump."""
    snapshot, styles = colored(mesh_of_chance()), stack_of(stack)
    rest = drawn(device, snapshot, styles)
    close = drawn(device, snapshot, styles, at_rest(snapshot.mesh))
    assert (close[..., 3] == 255).all()
    assert np.abs(close[..., :3].astype(int) - rest).max() <= 1


def test_what_moves_takes_everything_along(device: str) -> None:
    """Strokes, edges, gradients and the picture: shifted by whole pixels all are the same."""
    snapshot, styles = colored(mesh_of_chance()), stack_of("ink")
    rest, moved = drawn(device, snapshot, styles), at_rest(snapshot.mesh)
    shifted = replace(moved, corners=moved.corners + np.array([11, 6]))
    pixels = drawn(device, snapshot, styles, shifted)
    assert np.abs(pixels[6:, 11:, :3].astype(int) - rest[:-6, :-11]).max() <= 1
    assert (pixels[6:, 11:, 3] == 255).all()
    assert (pixels[:6, :, 3] == 0).all()
    assert (pixels[:, :11, 3] == 0).all()
    picture = drawn(device, snapshot, stack_of("picture")[:1], shifted)
    assert np.abs(picture[6:, 11:, :3].astype(int) - waves(*SIZE)[:-6, :-11]).max() <= 1


def test_holes_show_the_ground(device: str) -> None:
    """What was drawn before, to the bit; so does a triangle of which nothing is there."""
    snapshot, ground = colored(mesh_of_chance()), waves(*SIZE)
    moved = at_rest(snapshot.mesh)
    away = replace(moved, corners=moved.corners + np.array([2 * SIZE[0], 0]))
    absent = replace(moved, presence=np.zeros(len(moved.presence)))
    half = replace(moved, presence=np.full(len(moved.presence), 0.5))
    styles = (Backcloth(), STYLES["flat"]())
    for nothing in (away, absent):
        assert np.array_equal(drawn(device, snapshot, styles, nothing, ground), ground)
    mixed = drawn(device, snapshot, styles, half, ground).astype(int)
    rest = drawn(device, snapshot, styles[1:]).astype(int)
    assert np.abs(mixed - (rest + ground) / 2).max() <= 1


def test_the_nearer_triangle_is_seen(device: str) -> None:
    """Of two that are as near, the one with the larger number, whatever their rows."""
    mesh = mesh_of_chance()
    snapshot = colored(mesh)
    whole = np.array([[-1.0, -1.0], [400.0, -1.0], [-1.0, 400.0]])
    count = mesh.triangle_count
    for depths in (np.zeros(count), np.sin(np.arange(count))):
        moved = replace(at_rest(mesh), corners=np.tile(whole, (count, 1, 1)), depths=depths)
        pixels = drawn(device, snapshot, (STYLES["flat"](),), moved)
        top = np.lexsort((mesh.triangle_ids, depths))[-1]
        assert (pixels[..., :3] == snapshot.coefficients[top, :, 0]).all()


@pytest.mark.parametrize("name", MOVES)
def test_ways_follow_from_ids(name: str) -> None:
    """The rows of triangles mean nothing, and any frame can be drawn alone."""
    resting, move = resting_of(mesh_of_chance()), MOVES[name](amount=0.6)
    order = np.random.default_rng(1).permutation(len(resting.ids))
    mixed = replace(
        resting,
        corners=resting.corners[order],
        ids=resting.ids[order],
        vertex_ids=resting.vertex_ids[order],
        colors=resting.colors[order],
    )
    found = move.moved(Pose.at_rest(resting), resting, 0.6)
    other = move.moved(Pose.at_rest(mixed), mixed, 0.6)
    for part in ("corners", "presence", "light", "depths"):
        np.testing.assert_allclose(getattr(found, part)[order], getattr(other, part), atol=1e-9)


@pytest.mark.parametrize("name", MOVES)
def test_ways_have_no_jumps(name: str) -> None:
    """Neither in the amount nor, where a drawing is not held, in time."""
    resting, move = resting_of(mesh_of_chance()), MOVES[name](amount=0.5)
    pose = Pose.at_rest(resting)
    amounts = np.linspace(0.002, 1.0, 500)
    ways = [move.moved(pose, resting, float(amount)) for amount in amounts]
    corners, seen = np.array([w.corners for w in ways]), np.array([w.presence for w in ways])
    far = 0.02 * resting.diagonal  # of the fastest: a flight over the picture in 50 steps
    # what is too near to be seen from afar crosses the picture within a step
    inside = ((corners > -40) & (corners < 140)).all(axis=(2, 3))
    steps = np.abs(np.diff(corners, axis=0)).max(axis=(2, 3))
    assert steps[inside[1:] & inside[:-1]].max() < 2 * far
    assert np.abs(ways[0].corners - resting.corners)[ways[0].presence > 0].max(initial=0) < far
    assert np.abs(np.diff(seen, axis=0)).max() < 0.2
    later = move.moved(pose, replace(resting, time=resting.time + 0.004), 0.5)
    now = move.moved(pose, resting, 0.5)
    assert np.abs(later.corners - now.corners).max() < far


@pytest.mark.parametrize("name", FIRM)
def test_firm_moves_leave_no_hole(name: str) -> None:
    """Corners that meet stay together, and the border keeps its place."""
    resting = resting_of(mesh_of_chance())
    corners = MOVES[name]().moved(Pose.at_rest(resting), resting, 1.0).corners
    places: dict[int, np.ndarray] = {}
    for vertex, place in zip(resting.vertex_ids.ravel(), corners.reshape(-1, 2), strict=True):
        assert np.array_equal(places.setdefault(vertex, place), place)
    for axis, side in enumerate(SIZE):
        for border in (0, side):
            held = resting.corners[..., axis] == border
            assert (corners[..., axis][held] == border).all()


def test_moves_run_by_themselves() -> None:
    """From a time on, and back; a given amount holds whatever the time."""
    move = MOVES["explode"](start=1.0, seconds=2.0, back=5.0)
    assert [move.amount_at(time) for time in (0.0, 1.0, 2.0, 3.0, 5.0, 6.0, 9.0)] == [
        *(0.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0)
    ]
    assert replace(move, amount=0.25).amount_at(9.0) == 0.25
    title = MOVES["assemble"](seconds=4.0)
    assert [title.amount_at(time) for time in (0.0, 1.0, 4.0, 9.0)] == [1.0, 0.75, 0.0, 0.0]
    beat = MOVES["pulse"](every=0.5)
    assert beat.amount_at(1.0) == beat.amount_at(0.5) == 1.0


def test_everything_has_left_at_the_end() -> None:
    """What falls and what is not there yet leave nothing on the picture."""
    resting = resting_of(mesh_of_chance())
    pose = Pose.at_rest(resting)
    for order in ("size", "random", "left"):
        found = MOVES["assemble"](order=order).moved(pose, resting, 1.0)
        assert (found.presence == 0.0).all()
    fallen = MOVES["shatter"]().moved(pose, resting, 1.0).corners
    assert (fallen[..., 1].min(axis=1) > SIZE[1] - 6).mean() > 0.98


def test_mistakes_are_told() -> None:
    """In one line, with what would do."""
    with pytest.raises(OptionError, match=r"wait=2: must lie between 0 and 0\.9"):
        parse_member("--move", "explode:wait=2", MOVES)
    with pytest.raises(OptionError, match="choose from size, distance"):
        parse_member("--move", "assemble:order=weight", MOVES)
    with pytest.raises(OptionError, match="explode"):
        parse_member("--move", "explod", MOVES)
    with pytest.raises(OptionError, match=r"assemble:amount=0\.5"):
        check_moment([MOVES["assemble"]()])
    check_moment([MOVES["assemble"](amount=0.5), MOVES["wave"]()])


def test_every_parameter_says_what_it_may_be() -> None:
    """A help, and a range of numbers."""
    for move in MOVES.values():
        for field in parameters(move):
            assert field.metadata["help"]
            assert "range" in field.metadata or not str(field.type).startswith(("float", "int"))
