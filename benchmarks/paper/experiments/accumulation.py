"""Sec. 6.5: integer sums against floating-point ones, in several orders."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.paper.labels import triangle_of_pixels
from benchmarks.paper.methods import ours
from benchmarks.paper.page import Check, Section
from benchmarks.paper.study import Study
from benchmarks.timing import layout_of, table
from warp_kernels.device.device import Device

HEADS = (
    "colours",
    "sums in",
    "largest error of E(T), relative",
    "error of sqrt(2 E(T) / 3 q), largest [code values]",
    "median [code values]",
    "same bits in every order",
)


@dataclass(frozen=True)
class Format:
    """What the sums are kept in."""

    name: str
    number: type
    """NumPy's type."""
    unit: float = 1.0
    """Code values to one unit of the colours that are added."""


FORMATS = (
    Format("int64", np.int64),
    Format("float64, colours 0..255", np.float64),
    Format("float64, colours 0..1", np.float64, 255.0),
    Format("float32, colours 0..255", np.float32),
    Format("float32, colours 0..1", np.float32, 255.0),
)
EXACT = FORMATS[0]


@dataclass(frozen=True)
class Accumulation:
    """The energies of one mesh from the same pixels, added in different formats and orders."""

    triangles: int = 700
    orders: int = 4
    """Row by row, backwards, and shuffled."""

    def run(self, study: Study) -> Section:
        """Add up one picture."""
        pixels = study.pictures[study.first]
        mesh = layout_of(pixels, self.triangles)
        labels = triangle_of_pixels(study.device, mesh).ravel()
        rows, agree = [], True
        for color, energies_of in ENERGIES.items():
            fit = study.fit(study.first, mesh, color)
            exact = energies_of(pixels, labels, mesh.triangle_count, EXACT, None)
            agree &= bool(np.allclose(fit.energies, exact, rtol=1e-9, atol=1e-3))
            agree &= np.array_equal(fit.counts, np.bincount(labels, minlength=len(fit.counts)))
            for number_format in FORMATS:
                runs = [
                    energies_of(pixels, labels, mesh.triangle_count, number_format, order)
                    for order in self._orders(len(labels))
                ]
                rows.append(_row(color, number_format, runs, exact, fit.counts))
        same = self._same_with_threads(study)
        body = (
            f"{study.first}, {mesh.triangle_count} triangles, coordinates from the "
            f"picture's corner. The sums of one mesh are added in {self.orders} orders, as the "
            "atomic additions of a GPU come in no fixed one, and solved in float64 alike; q is "
            "the number of pixels of a triangle. The reference is the integer sum, which is "
            "exact; float64 sums of whole numbers are as well, as long as they fit into 53 bits. "
            "The paper's integers deviate by 0.023 (constant) and 0.029 (linear) code values "
            f"from its doubles.\n\n{table(HEADS, rows)}"
        )
        checks = (
            Check(
                "the program's energies and counts equal sums over pixels",
                "relative 1e-9",
                "equal" if agree else "different",
                agree,
            ),
            Check(
                "a triangulation with one thread and with three",
                "same bits",
                "same" if same else "different",
                same,
            ),
        )
        return Section("Sec. 6.5: integers against floating point", body, checks)

    def _orders(self, count: int) -> list[np.ndarray]:
        """Orders of the pixels, [count] each."""
        rows = np.arange(count)
        chance = np.random.default_rng(0)
        return [rows, rows[::-1], *(chance.permutation(count) for _ in range(self.orders - 2))]

    def _same_with_threads(self, study: Study) -> bool:
        """Whether the number of threads changes a bit of a short triangulation."""
        method = ours().with_options(iterations=40)
        one, three = (
            replace(study, device=Device("cpu", threads))
            .triangulate(study.first, method, self.triangles)
            .snapshot
            for threads in (1, 3)
        )
        return np.array_equal(one.mesh.vertices, three.mesh.vertices) and np.array_equal(
            one.energies, three.energies
        )


def _row(
    color: str,
    number_format: Format,
    runs: list[np.ndarray],
    exact: np.ndarray,
    counts: np.ndarray,
) -> tuple:
    """How far the runs are from the exact energies."""
    some = counts > 0
    samples = 3.0 * counts[some]
    relative = max(np.max(np.abs(r - exact)[some] / np.maximum(exact[some], 1.0)) for r in runs)
    true = np.sqrt(2 * exact[some] / samples)
    errors = [np.abs(np.sqrt(2 * np.maximum(r[some], 0) / samples) - true) for r in runs]
    same = all(np.array_equal(runs[0], run) for run in runs)
    return (
        color,
        number_format.name,
        f"{relative:.1e}",
        f"{max(e.max() for e in errors):.1e}",
        f"{max(np.median(e) for e in errors):.1e}",
        "yes" if same else "no",
    )


def _sums(
    labels: np.ndarray,
    values: np.ndarray,
    count: int,
    number_format: Format,
    order: np.ndarray | None,
) -> np.ndarray:
    """Values [N] added up by label, one after the other in an order, [count] float64."""
    if order is not None:
        labels, values = labels[order], values[order]
    sums = np.zeros(count, dtype=number_format.number)
    np.add.at(sums, labels, values.astype(number_format.number))
    return sums.astype(np.float64)


def _colors(pixels: np.ndarray, number_format: Format) -> np.ndarray:
    """Colours in the format's unit, [N, 3]."""
    values = pixels.reshape(-1, 3).astype(number_format.number)
    return values if number_format.unit == 1.0 else values / values.dtype.type(number_format.unit)


def constant_energies(
    pixels: np.ndarray,
    labels: np.ndarray,
    count: int,
    number_format: Format,
    order: np.ndarray | None,
) -> np.ndarray:
    """E(T) of Eq. 4 with the mean colour [code value^2 px], [count].

    Args:
        pixels: The picture, [H, W, 3] uint8.
        labels: Triangle of each pixel, row by row.
        count: Number of triangles.
        number_format: Of the sums.
        order: In which the pixels are added, None for row by row.
    """
    values = _colors(pixels, number_format)

    def total(terms: np.ndarray) -> np.ndarray:
        """The terms [N] by triangle."""
        return _sums(labels, terms, count, number_format, order)

    covered = np.maximum(total(np.ones(len(labels), np.int64)), 1.0)
    explained = sum(total(values[:, channel]) ** 2 for channel in range(3)) / covered
    left = total((values**2).sum(axis=1)) - explained
    return 0.5 * number_format.unit**2 * left


def linear_energies(
    pixels: np.ndarray,
    labels: np.ndarray,
    count: int,
    number_format: Format,
    order: np.ndarray | None,
) -> np.ndarray:
    """E(T) of Eq. 4 with the best linear colour, App. A [code value^2 px], [count].

    Args: as `constant_energies`.
    """
    height, width = pixels.shape[:2]
    values = _colors(pixels, number_format)
    y, x = (axis.ravel() for axis in np.mgrid[:height, :width])
    basis = (np.ones_like(x), x, y)

    def total(terms: np.ndarray) -> np.ndarray:
        """The terms [N] by triangle."""
        return _sums(labels, terms, count, number_format, order)

    matrix = np.stack([np.stack([total(a * b) for a in basis], -1) for b in basis], -2)
    right = np.stack([np.stack([total(a * values[:, c]) for a in basis], -1) for c in range(3)], -1)
    squares = total((values**2).sum(axis=1))
    solution = np.linalg.pinv(matrix, rcond=1e-13, hermitian=True) @ right
    energies = 0.5 * number_format.unit**2 * (squares - (solution * right).sum(axis=(1, 2)))
    # as the program does where the pixels of a triangle lie on a line
    flat = constant_energies(pixels, labels, count, number_format, order)
    return np.where(_spread_out(labels, count, basis), energies, flat)


def _spread_out(labels: np.ndarray, count: int, basis: tuple[np.ndarray, ...]) -> np.ndarray:
    """Which triangles have pixels that do not lie on a line, [count] bool; exact."""
    (n, x, y), (_, xx, xy), (_, _, yy) = (
        [_sums(labels, a * b, count, EXACT, None).astype(np.int64).astype(object) for a in basis]
        for b in basis
    )
    return ((n * xx - x * x) * (n * yy - y * y) - (n * xy - x * y) ** 2 > 0).astype(bool)


ENERGIES: dict[str, Callable[..., np.ndarray]] = {
    "constant": constant_energies,
    "linear": linear_energies,
}
"""By colour model."""
