"""`.npz` and `.csv` are what docs/data.md says, name by name."""

import re
from pathlib import Path

import numpy as np
import pytest

from stages.exchange.arrays import SCHEMA
from tests.films import film_of, format_with, graded_figures, mixed_figures

PAGE = (Path(__file__).parents[1] / "docs" / "data.md").read_text("utf-8")
NAMED = re.findall(r"^\| (`[^|]*`) \| ([^|]*) \|(?: ([^|]*) \|)?$", PAGE, flags=re.MULTILINE)
"""Names, meanings and shapes of the tables."""


@pytest.mark.parametrize("made", [mixed_figures, graded_figures])
def test_arrays_are_those_of_the_page(tmp_path: Path, made) -> None:
    figures = made()
    format_with(film_of(".npz"), figures).save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as found:
        arrays = dict(found)
    told = {names.strip("`"): shape.split(", ") for names, _, shape in NAMED if shape}
    assert list(told) == list(arrays)
    counts = {
        "F": len(figures),
        "F + 1": len(figures) + 1,
        "V": sum(figure.mesh.vertex_count for figure in figures),
        "T": sum(figure.mesh.triangle_count for figure in figures),
        "K": figures[0].snapshot.model.term_count,
        "2": 2,
        "3": 3,
    }
    for name, (*sizes, kind) in told.items():
        shape = tuple(counts[size] for one in sizes for size in one.split(" x "))
        assert (arrays[name].shape, arrays[name].dtype) == (shape, kind), name
    assert arrays["schema"] == SCHEMA
    assert f"version of this table: {SCHEMA}" in PAGE


def test_columns_are_those_of_the_page(tmp_path: Path) -> None:
    figures = mixed_figures()
    format_with(film_of(".csv"), figures).save(tmp_path / "a.csv")
    header = (tmp_path / "a.csv").read_text("utf-8").splitlines()[0].split(",")
    told = [re.findall("`([^`]*)`", names) for names, _, shape in NAMED if not shape]
    assert header == [name for row in told for name in row]
    table = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True)
    assert len(table) == sum(figure.mesh.triangle_count for figure in figures)
    ids = np.concatenate([figure.mesh.triangle_ids for figure in figures])
    np.testing.assert_array_equal(table["triangle"], ids)
    seconds = np.repeat([float(f.time) for f in figures], [f.mesh.triangle_count for f in figures])
    np.testing.assert_allclose(table["time"], seconds, rtol=1e-8)


def test_energies_are_half_of_the_squared_errors() -> None:
    """As the page says; the rest of the program counts so."""
    snapshot = graded_figures()[0].snapshot
    pixels = 3 * snapshot.mesh.width * snapshot.mesh.height
    assert snapshot.rmse**2 * pixels == pytest.approx(2 * snapshot.energies.sum())
