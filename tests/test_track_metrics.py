"""What a track's meshes do from frame to frame: counted by hand on small meshes."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from meshes import HEIGHT, WIDTH, random_mesh, scrambled, two_triangles
from test_track import failure

from pipeline.cli import main
from pipeline.compare.lifetimes import Lifetimes
from pipeline.loop.animate import animate
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.edits import (
    collapse_edges,
    collapsible,
    flip_edges,
    flippable,
    independent_flips,
    split_edges,
    split_triangles,
)
from stages.flows.field import FlowField
from stages.media import FrameRange
from stages.mesh import Mesh, areas_of
from stages.metrics.drift import drift, jitter
from stages.metrics.locate import locate
from stages.metrics.mesh_changes import mesh_changes
from stages.metrics.motion import SourceMotion
from stages.metrics.pop_energy import pop_energy
from stages.snapshot import Snapshot
from tests import media_samples as samples
from tests.jobs import job_of
from tests.tracks import CUT, QUICK, write_clip
from warp_kernels.color_model import CONSTANT, LINEAR, ColorModel

TRACK_KEYS = {"births", "deaths", "flips", "jitter", "pop_energy", "inverted"}


def still(mesh: Mesh) -> SourceMotion:
    """No motion over a mesh's domain."""
    return SourceMotion(*2 * (FlowField.still(mesh.width, mesh.height),))


def painted(mesh: Mesh, grays: object, model: ColorModel = CONSTANT) -> Snapshot:
    """A snapshot whose triangles are grey, [T] or one for all."""
    coefficients = np.zeros((mesh.triangle_count, 3, model.term_count))
    coefficients[:, :, 0] = np.broadcast_to(grays, mesh.triangle_count)[:, None]
    nothing = np.zeros(mesh.triangle_count)
    pixels = nothing.astype(np.int64)
    return Snapshot(0, 0, Fraction(1, 25), mesh, model, coefficients, nothing, pixels)


def counts(before: Mesh, after: Mesh) -> tuple[int, int, int]:
    """Births, deaths, flips."""
    changes = mesh_changes(before, after)
    return changes.births, changes.deaths, changes.flips


def inner_collapse(mesh: Mesh) -> np.ndarray:
    """One half-edge that may collapse."""
    return np.flatnonzero(collapsible(mesh, np.arange(3 * mesh.triangle_count)))[:1]


def test_flip_is_counted_once() -> None:
    """The diagonal of a square, there and back."""
    before = two_triangles()
    after = flip_edges(before, np.flatnonzero(before.twins >= 0)[:1])
    assert counts(before, before) == (0, 0, 0)
    assert counts(before, after) == counts(after, before) == (0, 0, 1)


@pytest.mark.parametrize("seed", range(3))
def test_edits_are_counted(seed: int) -> None:
    """Flips, splits and a collapse; the vertices that they bring or take are no flips."""
    mesh = random_mesh(seed)
    edges = mesh.edge_half_edges[flippable(mesh, mesh.edge_half_edges, min_height=1e-3)]
    flips = edges[independent_flips(mesh, edges)]
    assert counts(mesh, flip_edges(mesh, flips)) == (0, 0, len(flips))
    assert counts(mesh, split_triangles(mesh, np.array([3, 8]))) == (2, 0, 0)
    inner, border = (np.flatnonzero(kind)[:1] for kind in (mesh.twins >= 0, mesh.twins < 0))
    assert counts(mesh, split_edges(mesh, inner)) == (1, 0, 0)
    assert counts(mesh, split_edges(mesh, border)) == (1, 0, 0)
    assert counts(mesh, collapse_edges(mesh, inner_collapse(mesh))) == (0, 1, 0)


@pytest.mark.parametrize("seed", range(3))
def test_edits_together_are_counted(seed: int) -> None:
    """A flip far from a split is one; rows and vertices may stand in any order."""
    mesh = random_mesh(seed)
    edges = mesh.edge_half_edges[flippable(mesh, mesh.edge_half_edges, min_height=1e-3)]
    far = np.abs(mesh.vertices[mesh.triangles[edges // 3, 0]] - mesh.vertices[5]).sum(axis=1)
    flipped = flip_edges(mesh, edges[far.argmax()][None])
    nearest = np.abs(flipped.vertices[flipped.triangles].mean(axis=1) - mesh.vertices[5])
    split = split_triangles(flipped, nearest.sum(axis=1).argmin()[None])
    assert counts(mesh, split) == (1, 0, 1)
    order = np.random.default_rng(seed).permutation(split.vertex_count)
    places = np.argsort(order)
    mixed = replace(
        split,
        vertices=split.vertices[order],
        vertex_ids=split.vertex_ids[order],
        triangles=places[split.triangles][::-1],
        triangle_ids=split.triangle_ids[::-1],
    )
    assert counts(split, mixed) == (0, 0, 0)
    assert counts(mesh, mixed) == (1, 0, 1)


@pytest.mark.parametrize("seed", range(3))
def test_points_are_located(seed: int, rng: np.random.Generator) -> None:
    """Every point lies in the triangle found for it, slivers and borders included."""
    mesh = scrambled(random_mesh(seed), seed)
    points = rng.random((400, 2)) * (WIDTH, HEIGHT)
    points = np.concatenate([points, mesh.vertices, [[0, 0], [WIDTH, 0], [WIDTH, 7.5]]])
    corners = mesh.vertices[mesh.triangles[locate(mesh, points)]]
    for start in range(3):
        side = np.stack([corners[:, start], corners[:, (start + 1) % 3], points], axis=1)
        assert areas_of(side).min() > -1e-9


def test_pop_energy_by_hand() -> None:
    """A flip of two triangles of 8 px^2, whose centroids lie in one old triangle each."""
    before = two_triangles()  # halves (0, 1, 3) and (1, 2, 3)
    after = flip_edges(before, np.flatnonzero(before.twins >= 0)[:1])
    one, other = painted(before, 100), painted(after, 151)
    assert pop_energy(one, other, still(before)) == pytest.approx(0.04)
    assert pop_energy(one, painted(after, 100), still(before)) == 0.0
    assert pop_energy(one, painted(before, 151), still(before)) == 0.0  # no change of topology
    # Colours that are drawn alike are alike.
    assert pop_energy(painted(before, 255), painted(after, 300), still(before)) == 0.0


def test_pop_energy_is_symmetric_in_time() -> None:
    """Splits played backwards are collapses; only the star counts, in any colour model."""
    mesh = random_mesh(0)
    after = collapse_edges(mesh, inner_collapse(mesh))
    stays = np.isin(mesh.vertex_ids, after.vertex_ids)
    star = mesh.areas[~stays[mesh.triangles].all(axis=1)].sum()
    for model in (CONSTANT, LINEAR):
        there, back = painted(mesh, 0, model), painted(after, 51, model)
        forth = pop_energy(there, back, still(mesh))
        assert forth == pytest.approx(0.04 * star / (WIDTH * HEIGHT))
        assert pop_energy(back, there, still(mesh)) == pytest.approx(forth)


def test_pop_energy_follows_the_motion() -> None:
    """A step of brightness that moves by 40 px: new triangles have the colour that moved there."""
    mesh = random_mesh(1, inner=300)
    bright = mesh.vertices[mesh.triangles, 0].mean(axis=1)
    edges = mesh.edge_half_edges[flippable(mesh, mesh.edge_half_edges, min_height=0.2)]
    after = flip_edges(mesh, edges[independent_flips(mesh, edges)])
    moved = after.vertices[after.triangles, 0].mean(axis=1)
    one, other = painted(mesh, 200 * (bright > 20)), painted(after, 200 * (moved > 60))
    vectors = np.full((1, 1, 2), (40, 0), np.float32)
    motion = SourceMotion(*(FlowField(WIDTH, HEIGHT, sign * vectors) for sign in (1, -1)))
    assert pop_energy(one, other, motion) < 0.3 * pop_energy(one, other, still(mesh))


def test_jitter_by_hand() -> None:
    """Inner vertices leave the motion by 0.5 px once: so long is their second difference."""
    mesh = random_mesh(2)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    flow = FlowField(WIDTH, HEIGHT, np.full((1, 1, 2), (0.25, -0.5), np.float32))
    steps = np.where(inner[:, None], (0.25, -0.5), 0.0)
    steps[mesh.on_left_right & ~mesh.on_top_bottom, 1] = -0.5
    steps[mesh.on_top_bottom & ~mesh.on_left_right, 0] = 0.25
    riding = mesh.moved(mesh.vertices + steps)
    assert np.abs(drift(mesh, riding, flow).steps).max() < 1e-12
    shaken = riding.moved(riding.vertices + inner[:, None] * (0.5, 0.0))
    back = shaken.moved(shaken.vertices + steps)
    to, fro = drift(mesh, shaken, flow), drift(shaken, back, flow)
    assert jitter(to, fro) == pytest.approx(0.5 * inner.mean())
    assert jitter(to, to) == 0.0


def test_jitter_needs_vertices_of_three_frames() -> None:
    """Those that were just born or died do not count."""
    mesh, flow = random_mesh(0), FlowField.still(WIDTH, HEIGHT)
    born = split_triangles(mesh, np.array([0]))
    first, second = drift(mesh, mesh, flow), drift(mesh, born, flow)
    assert len(second.vertex_ids) == mesh.vertex_count
    apart = replace(first, vertex_ids=first.vertex_ids + 10_000)
    assert jitter(first, second) == 0.0
    assert jitter(apart, second) is None


def test_median_life_by_hand() -> None:
    """Lives of 3, 2, 1, 2 and 1 frames; the living count as well; a new shot ends them all."""
    lifetimes = Lifetimes()
    assert lifetimes.median() is None
    for number, ids in enumerate(([2, 0, 1], [3, 1, 0], [0, 3, 4])):
        lifetimes.add(np.array(ids), goes_on=number > 0)
    assert lifetimes.median() == 2.0
    lifetimes.add(np.array([0]), goes_on=False)  # a sixth life, of 1 frame, whatever its number
    assert lifetimes.median() == 1.5


def test_median_life_equals_a_count(rng: np.random.Generator) -> None:
    """Against sets of ids counted one by one."""
    lifetimes, ages = Lifetimes(), {}
    ids, fresh = np.arange(40), 40
    for number in range(30):
        lifetimes.add(rng.permutation(ids), goes_on=number > 0)
        for one in ids.tolist():
            ages[one] = ages.get(one, 0) + 1
        born = int(rng.integers(0, 9))
        ids = np.concatenate([ids[rng.random(len(ids)) < 0.8], fresh + np.arange(born)])
        fresh += born
    assert lifetimes.median() == np.median(list(ages.values()))


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Path]:
    """A clip with a cut, what was drawn of its frames 4 to 8, and the track."""
    folder = tmp_path_factory.mktemp("drawn")
    clip = write_clip(folder / "in.mp4")
    convert(clip, folder / "out.mkv", "4-8")
    return clip, folder / "out.mkv", folder / "out.mtrk"


def convert(clip: Path, output: Path, frames: str, **options: object) -> None:
    """Convert some frames, with a track beside the output."""
    track = output.with_suffix(".mtrk")
    wanted = FrameRange.parse(frames)
    job = job_of(clip, output, frame_range=wanted, track=track, triangulate=QUICK, **options)
    animate(job, Progress())


def test_track_brings_its_range_and_shots(drawn: tuple, capsys) -> None:
    """Without --frames those of the track are compared; nothing is compared across the cut."""
    clip, output, track = map(str, drawn)
    assert main(["measure", clip, output, "--track", track, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    frames = values["per_frame"]
    assert [frame["frame"] for frame in frames] == [4, 5, 6, 7, 8]
    assert all(frame["track"].keys() == TRACK_KEYS for frame in frames)
    opening = [frame["frame"] for frame in frames if frame["track"]["births"] is None]
    assert opening == [4, CUT]
    assert [frame["frame"] for frame in frames if frame["E_warp_1"] is None] == [4, CUT]
    assert [f["frame"] for f in frames if f["track"]["jitter"] is not None] == [8]
    assert values["track"].keys() == TRACK_KEYS | {"median_life"}
    assert values["track"]["inverted"] == 0
    assert 1 <= values["track"]["median_life"] <= 3
    with TrackReader(drawn[2]) as reader:
        changes = mesh_changes(reader.snapshot(7).mesh, reader.snapshot(8).mesh)
    assert frames[-1]["track"]["births"] == changes.births
    assert frames[-1]["track"]["flips"] == changes.flips


def test_table_tells_of_the_track(drawn: tuple, capsys) -> None:
    """A part of the frames, as lines."""
    clip, output, track = map(str, drawn)
    assert main(["measure", clip, output, "--track", track, "--frames", "4-8"]) == 0
    text = capsys.readouterr().out
    for label in ("births", "deaths", "flips", "jitter", "pop energy", "median life", "inverted"):
        assert f"\n{label}" in text


def test_independent_frames_share_nothing(drawn: tuple, tmp_path: Path, capsys) -> None:
    """Their ids begin anew in each: equal numbers are no lives."""
    output = tmp_path / "out.mkv"
    convert(drawn[0], output, "0-2", independent=True)
    track = output.with_suffix(".mtrk")
    assert main(["measure", str(drawn[0]), str(output), "--track", str(track), "--json"]) == 0
    values = json.loads(capsys.readouterr().out)["track"]
    with TrackReader(track) as reader:
        vertices = [reader.snapshot(frame).mesh.vertex_count for frame in range(3)]
    assert values["births"] == np.mean(vertices[1:])
    assert values["deaths"] == np.mean(vertices[:-1])
    assert (values["median_life"], values["jitter"], values["flips"]) == (1.0, None, 0.0)


def test_inverted_triangles_are_counted(drawn: tuple, tmp_path: Path) -> None:
    """A vertex that was pushed over the opposite edge folds its star."""
    from pipeline.compare.track_measures import TrackMeter

    with TrackReader(drawn[2]) as reader:
        meter = TrackMeter(reader, drawn[0])
        snapshot = reader.snapshot(4)
        inner = ~(snapshot.mesh.on_left_right | snapshot.mesh.on_top_bottom)
        vertices = np.where(inner[:, None], (1.0, 1.0), snapshot.mesh.vertices)
        folded = replace(snapshot, mesh=snapshot.mesh.moved(vertices))
        reader.snapshot = lambda frame: folded  # type: ignore[method-assign]
        found = meter.add(4, None)
    assert found.inverted == np.count_nonzero(folded.mesh.areas <= 0) > 0
    assert meter.total([found]).inverted == found.inverted


def test_track_of_something_else_is_refused(drawn: tuple, tmp_path: Path, capsys) -> None:
    """Another source, other frames, no track: what, and what to do; nothing is printed."""
    clip, output, track = drawn
    other = samples.write_video(tmp_path / "other.mp4", [samples.picture(96, 64)] * 5)
    code, line = failure(capsys, "measure", other, output, "--track", track)
    assert code == 3
    assert "is not the source that the track was made from" in line
    short = tmp_path / "short.mkv"
    convert(clip, short, "0-1")
    code, line = failure(capsys, "measure", clip, short, "--track", track, "--frames", "0-1")
    assert code == 3
    assert "holds no frame 0 (frames: 4 to 8)" in line
    quiet = ("--progress", "none")
    code, line = failure(capsys, "measure", clip, short, "--track", track, *quiet)
    assert code == 1
    assert "has 2 frames" in line
    assert failure(capsys, "measure", clip, output, "--track", clip)[0] == 3
    assert failure(capsys, "measure", clip, output, "--track", tmp_path / "no.mtrk")[0] == 3
    assert failure(capsys, "measure", clip, output, "--track", "")[0] == 2
