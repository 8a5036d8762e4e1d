"""How far the colours of a triangle may go: the picture has them where the triangle lies.

A polynomial that fits a strong edge leaves the range of its pixels, and one that fits a few pixels
leaves it far between and beside them: specks and fringes that the picture does not have. The mean
of a large triangle over a strong border may be a third colour, deep on both sides of the border.
"""

import numpy as np

from stages.mesh import Mesh, centres_of
from stages.snapshot import with_origins
from warp_kernels.color_model import CHANNELS, ColorModel
from warp_kernels.energy.color_bands import Bands
from warp_kernels.energy.color_extremes import BRIGHTEST, DARKEST, Extremes
from warp_kernels.energy.nearby_colors import Departures, Nearby
from warp_kernels.energy.workspace import Workspace

SLACK = 12.0
"""Most that a colour may leave the range of the pixels below [code values]."""
REACH = 1.0
"""Tips of triangles reach about so far beyond the centres of their outermost pixels, along x and
along y [px]: there an even slope goes on."""
STEPS = (1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5)
"""How much of what they ask for the worst pixels get, time after time: half of it at last, for two
that cannot both have it meet in the middle."""
DEAREST = 2.0
"""Most that moved colours may leave, as a multiple of what the best ones do: the colour of the
larger side of a border costs no more than that, and the smaller side is not followed at the expense
of the larger."""
UNKNOWN = 1e300
"""Bound for the energy of a triangle in a colour that is tried [code value^2 px]."""
RIDGE = 1e-6
"""Keeps the least change unique in triangles that are almost lines [1]."""
SAMPLES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 6 + 1 / 9
"""Places that stand for a triangle's pixels, as shares of its corners, [15, 3]."""


def limits_of(
    mesh: Mesh, model: ColorModel, coefficients: np.ndarray, extremes: np.ndarray
) -> np.ndarray:
    """The lowest and the highest value of every channel that a triangle may show.

    Args:
        mesh: The triangles.
        model: Fixes the terms.
        coefficients: As in a snapshot, [T, 3, K].
        extremes: Least and largest values of the pixels below [code values], [T, 2, 3] uint8.

    Returns:
        Whole code values, [T, 2, 3] uint8.
    """
    x, y = centres_of(mesh.corners).T
    steepness = np.zeros(coefficients.shape[:2])
    for axis in (0, 1):
        slope = np.zeros_like(steepness)
        for term, (a, b) in enumerate(model.exponents):
            power = (a, b)[axis]
            if power:
                rest = x ** (a - (axis == 0)) * y ** (b - (axis == 1))
                slope += power * rest[:, None] * coefficients[:, :, term]
        steepness += np.abs(slope)
    slack = np.minimum(SLACK, REACH * steepness)
    limits = np.empty(extremes.shape)
    limits[:, 0] = np.floor(extremes[:, DARKEST] - slack)
    limits[:, 1] = np.ceil(extremes[:, BRIGHTEST] + slack)
    return np.clip(limits, 0.0, 255.0).astype(np.uint8)


class Limiter:
    """Keeps colours that were fitted within what the picture has near by.

    Args:
        workspace: Holds the picture in RGB, and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._extremes, self._nearby = Extremes(workspace), Nearby(workspace)
        one_color = workspace.model.degree == 0 and not workspace.device.is_cuda
        self._bands = Bands(workspace) if one_color else None
        self.torn = np.empty(0, dtype=np.int64)
        """Triangles of the mesh limited last that no one colour becomes, [N]."""

    def limit(
        self, mesh: Mesh, coefficients: np.ndarray, energies: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
        """Limit the colours of the mesh as it stands, and move those that must be others.

        Args:
            mesh: The triangles.
            coefficients: The best ones, as in a snapshot, [T, 3, K].
            energies: What they leave [code value^2 px], [T].

        Returns:
            Coefficients, energies, and limits, as in a snapshot.
        """
        model = self._workspace.model
        limits = np.empty((mesh.triangle_count, 2, CHANNELS), dtype=np.uint8)
        limits[:, 0], limits[:, 1] = 0, 255
        if model.degree > 0:
            extremes = self._extremes.measure(mesh.triangle_count)
            limits = limits_of(mesh, model, coefficients, extremes)
        coefficients, energies = self._moved(mesh, coefficients, energies, limits)
        return coefficients, energies, limits if model.degree > 0 else None

    def _moved(
        self, mesh: Mesh, coefficients: np.ndarray, energies: np.ndarray, limits: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Colours, and what they leave, of which fewer pixels look like nothing near them.

        Time after time the worst pixel of a triangle gets what it asks for, as the rest of the
        triangle bears it best; the colours stay that leave the fewest such pixels, unless the rest
        of the triangle would have to bear too much.
        """
        doubtful = energies
        if self._bands is not None:
            doubtful = np.where(self._bands.suspects(coefficients, energies), energies, 0.0)
        found = self._nearby.measure(coefficients, doubtful, limits)
        rows = self.torn = np.flatnonzero(found.counts)
        if not len(rows):
            return coefficients, energies
        best, had, least = coefficients, found.counts, found.counts
        coefficients, energies, moved = best.copy(), energies.copy(), best.copy()
        told, shifts = np.zeros(mesh.triangle_count), np.zeros((mesh.triangle_count, CHANNELS))
        for step in STEPS:
            origins = centres_of(mesh.corners[rows])
            changes = step * self._corrections(mesh, rows, found)
            local = with_origins(self._workspace.model, moved[rows], origins) + changes
            moved[rows] = with_origins(self._workspace.model, local, -origins)
            shifts[rows] += changes[:, :, 0]
            added = 0.5 * mesh.areas[rows] * (shifts[rows] ** 2).sum(axis=1)  # at least, about
            rows = rows[added <= (DEAREST - 1.0) * energies[rows]]
            tried = np.zeros(mesh.triangle_count)
            tried[rows] = UNKNOWN
            found = self._nearby.measure(moved, tried, limits)
            better = rows[found.counts[rows] < least[rows]]
            coefficients[better], told[better] = moved[better], np.inf
            least = np.where(tried > 0, np.minimum(least, found.counts), least)
            rows = rows[least[rows] > 0]
            if not len(rows):
                break
        left = self._nearby.measure(coefficients, told, limits).energies
        dear = left > DEAREST * energies
        coefficients[dear] = best[dear]
        self.torn = np.flatnonzero(np.where(dear, had, least))
        changed = (told > 0) & ~dear
        energies[changed] = left[changed]
        return coefficients, energies

    def _corrections(self, mesh: Mesh, rows: np.ndarray, found: Departures) -> np.ndarray:
        """Changes of coefficients around the centroids that give pixels what they ask for, and
        change the triangle least in the mean of squares, [N, 3, K]."""
        exponents = self._workspace.model.exponents
        corners = mesh.corners[rows]
        centres = centres_of(corners)[:, None]
        scales = np.sqrt(np.maximum(mesh.areas[rows], 1.0))[:, None]
        samples = (SAMPLES @ corners - centres) / scales[:, None]
        wanted = (found.places[rows] + 0.5 - centres) / scales[:, None]
        among, there = (
            np.stack([p[..., 0] ** a * p[..., 1] ** b for a, b in exponents], axis=-1)
            for p in (samples, wanted)
        )
        inertia = among.transpose(0, 2, 1) @ among / len(SAMPLES)
        inertia += RIDGE * np.eye(len(exponents))
        answers = np.linalg.solve(inertia, there.transpose(0, 2, 1)).transpose(0, 2, 1)
        answers *= (found.changes[rows] / (there * answers).sum(axis=2))[:, :, None]
        return answers / scales[:, None] ** np.array([a + b for a, b in exponents])
