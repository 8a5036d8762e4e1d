"""The report on the paper's experiments: the related tools' meshes, the sums, the page."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchmarks.paper.experiments import EXPERIMENTS
from benchmarks.paper.experiments.accumulation import ENERGIES, FORMATS, Accumulation
from benchmarks.paper.experiments.convergence import Convergence
from benchmarks.paper.experiments.paper_method import PaperMethod
from benchmarks.paper.experiments.random_starts import RandomStarts, RandomVertices
from benchmarks.paper.experiments.regularity import Regularity, smallest_angles
from benchmarks.paper.experiments.related_tools import RelatedTools
from benchmarks.paper.experiments.start_layout import StartLayout
from benchmarks.paper.experiments.step_times import StepTimes
from benchmarks.paper.experiments.thresholds import Thresholds
from benchmarks.paper.labels import triangle_of_pixels
from benchmarks.paper.methods import ours
from benchmarks.paper.page import write_page
from benchmarks.paper.pictures import LARGEST as MOST_PIXELS
from benchmarks.paper.pictures import folder_pictures, sample_pictures
from benchmarks.paper.related import RELATED
from benchmarks.paper.sheet import LARGEST as MOST_BYTES
from benchmarks.paper.sheet import save_small
from benchmarks.paper.study import Study
from stages.layouts.grid import Grid
from stages.validate import assert_valid
from tests.architecture_rules import markdown_links
from warp_kernels.device.device import Device

TINY = {
    "fig3": StartLayout(triangles=30),
    "fig4": Thresholds(taus=(9.0,), cap=40, shown=1),
    "method": PaperMethod(),
    "fig8": RelatedTools(sheets=1),
    "fig9": RandomStarts(triangles=40, starts=2),
    "fig10": Regularity(weights=(0.0,), triangles=30),
    "fig12": Convergence(triangles=30, shown=1),
    # quadratic colours take the same way, and their kernels half a minute to be compiled
    "fig13": StepTimes(counts=(30,), samples=1, colors=("constant",)),
    "sec65": Accumulation(triangles=30, orders=3),
}
"""The experiments, made small."""


def picture(width: int = 96, height: int = 72) -> np.ndarray:
    """A bright disc with soft noise on a dark slope, [H, W, 3] uint8."""
    y, x = np.mgrid[:height, :width]
    slope = np.stack([x, y, 0 * x], axis=-1) * 0.8
    noise = np.random.default_rng(3).normal(0, 4, slope.shape)
    pixels = (slope + noise).clip(0, 255).astype(np.uint8)
    cv2.circle(pixels, (width // 3, height // 2), height // 4, (230, 190, 90), cv2.FILLED)
    return pixels


@pytest.fixture
def study(tmp_path: Path) -> Study:
    """Two tiny pictures, one number of triangles."""
    pictures = {"disc": picture(), "disc, mirrored": np.ascontiguousarray(picture()[:, ::-1])}
    return Study(pictures, Device("cpu", 1), tmp_path / "paper", (60,), say=lambda text: None)


@pytest.mark.parametrize("name", RELATED)
def test_related_tool_meets_the_count(name: str) -> None:
    """Meshes are valid, have the wanted triangles within 1 %, and follow from the seed."""
    meshes = [
        RELATED[name]().build(picture(), count, np.random.default_rng(7)) for count in (60, 60, 251)
    ]
    for mesh, count in zip(meshes, (60, 60, 251), strict=True):
        assert_valid(mesh)
        assert mesh.triangle_count == pytest.approx(count, rel=0.01, abs=1)
    assert np.array_equal(meshes[0].vertices, meshes[1].vertices)
    assert np.array_equal(meshes[0].triangles, meshes[1].triangles)


@pytest.mark.parametrize("name", RELATED)
def test_related_tool_serves_a_picture_without_detail(name: str) -> None:
    """Where there is no edge and no corner, the mesh is valid all the same."""
    flat = np.full((50, 70, 3), 77, dtype=np.uint8)
    mesh = RELATED[name]().build(flat, 80, np.random.default_rng(0))
    assert_valid(mesh)
    assert mesh.triangle_count >= 2


def test_related_tools_see_the_picture(study: Study) -> None:
    """Each leaves less error than a regular grid, the uniform ones included."""
    grid = Grid().build(picture(), 200, np.random.default_rng(0))
    bound = study.fit("disc", grid, "constant").rmse
    for layout in RELATED.values():
        mesh = layout().build(picture(), 200, np.random.default_rng(0))
        assert study.fit("disc", mesh, "constant").rmse < bound


def test_random_vertices_are_valid() -> None:
    """Ten seeds, ten different valid meshes."""
    meshes = [
        RandomVertices().build(picture(), 500, np.random.default_rng(seed)) for seed in range(10)
    ]
    for mesh in meshes:
        assert_valid(mesh)
        assert mesh.vertex_count == 100
    assert len({mesh.vertices.tobytes() for mesh in meshes}) == 10


def test_labels_are_the_coverage_of_the_fit(study: Study) -> None:
    """Every pixel has one triangle, and triangles the pixels that the fit counts."""
    mesh = RandomVertices().build(picture(), 0, study.rng())
    labels = triangle_of_pixels(study.device, mesh)
    counts = np.bincount(labels.ravel(), minlength=mesh.triangle_count)
    assert np.array_equal(counts, study.fit("disc", mesh, "constant").counts)


@pytest.mark.parametrize("color", ENERGIES)
def test_integer_sums_are_those_of_the_program(study: Study, color: str) -> None:
    """Sums over pixels in any order give the energies of the fit."""
    mesh = RandomVertices(20).build(picture(), 0, study.rng())
    labels = triangle_of_pixels(study.device, mesh).ravel()
    expected = study.fit("disc", mesh, color).energies
    for order in (None, np.random.default_rng(1).permutation(len(labels))):
        energies = ENERGIES[color](picture(), labels, mesh.triangle_count, FORMATS[0], order)
        assert energies == pytest.approx(expected, rel=1e-9, abs=1e-3)


def test_watching_changes_nothing(study: Study) -> None:
    """The moments end with the solution, which is that of a run that nobody watches."""
    method = ours().with_options(iterations=24)
    watched = study.watch("disc", method, 40)
    alone = study.triangulate("disc", method, 40)
    assert np.array_equal(watched.snapshot.mesh.vertices, alone.snapshot.mesh.vertices)
    assert watched.moments[-1].iterations == 24
    assert watched.moments[-1].rmse == alone.rmse
    assert watched.moments[0].rmse > watched.moments[-1].rmse


def test_smallest_angles_of_known_triangles() -> None:
    """An equilateral triangle has 60 degrees, half a square 45."""
    corners = np.array([[[0, 0], [2, 0], [1, 3**0.5]], [[0, 0], [1, 0], [0, 1]]])
    assert smallest_angles(corners) == pytest.approx([60, 45])


def test_every_experiment_is_tried() -> None:
    """A new experiment gets a small form here on the day that it is registered."""
    assert [(name, type(tiny)) for name, tiny in TINY.items()] == list(EXPERIMENTS.items())


def test_report_is_whole(study: Study, tmp_path: Path) -> None:
    """The page has a section and its checks for each experiment, and all of its plots."""
    study = replace(study, pictures={"disc": picture()}, iterations=16)
    sections = [experiment.run(study) for experiment in TINY.values()]
    page = tmp_path / "paper.md"
    write_page(page, study, sections, "python -m benchmarks.paper")
    text = page.read_text(encoding="utf-8")
    assert all(f"## {section.title}" in text for section in sections)
    assert text.count("holds |") + text.count("**fails** |") == sum(
        len(section.checks) for section in sections
    )
    plots = {path.name for path in study.plots.iterdir()}
    assert {Path(link).name for link in markdown_links(text)} == plots
    assert all(path.stat().st_size <= MOST_BYTES for path in study.plots.iterdir())


def test_a_sheet_of_noise_stays_small(tmp_path: Path) -> None:
    """What no palette makes small enough is reduced until it is."""
    noise = np.random.default_rng(0).integers(0, 256, (120, 120, 3), dtype=np.uint8)
    save_small(tmp_path / "noise.png", noise, 5_000)
    assert (tmp_path / "noise.png").stat().st_size <= 5_000


def test_folder_pictures_are_reduced(tmp_path: Path) -> None:
    """Stills are found and reduced to the size of the paper's; an empty folder is an error."""
    with pytest.raises(SystemExit, match="no still"):
        folder_pictures(tmp_path)
    cv2.imwrite(str(tmp_path / "wide.png"), np.zeros((300, 1200, 3), dtype=np.uint8))
    (tmp_path / "notes.txt").write_text("no picture", encoding="utf-8")
    ((name, pixels),) = folder_pictures(tmp_path).items()
    assert name == "wide"
    assert pixels.shape[0] * pixels.shape[1] <= 1.01 * MOST_PIXELS
    assert pixels.shape[1] == pytest.approx(4 * pixels.shape[0], rel=0.01)


def test_samples_give_pictures() -> None:
    """Without a folder there are stills of the samples, none twice."""
    pictures = sample_pictures()
    assert len({pixels.tobytes() for pixels in pictures.values()}) == len(pictures) >= 5
