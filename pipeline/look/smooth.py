"""Smoothing over time, forwards and backwards alike: nothing lags behind the picture."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from pipeline.envelope import Solved
from stages.mesh import Mesh
from stages.motion.advect import sliding, unfolded
from stages.motion.correspondence import kept_triangles, kept_vertices
from stages.snapshot import Snapshot, with_origins

DEVIATIONS = 3
"""Standard deviations on either side within which frames count."""


@dataclass(frozen=True, eq=False)
class _Frame:
    """A frame in the window and how it hangs together with the one before."""

    solved: Solved
    colors: np.ndarray
    """Coefficients of positions that count from the triangles' centroids, [T, 3, K]."""
    limits: np.ndarray
    """What these colours keep to [code values], [T, 2, 3]."""
    vertices: np.ndarray
    """For every vertex its number in the frame before, or -1; [V]."""
    triangles: np.ndarray
    """For every triangle its number in the frame before, or -1; [T]."""

    @property
    def mesh(self) -> Mesh:
        """Its triangles."""
        return self.solved.snapshot.mesh


class Smoother:
    """Smooths the paths of vertices and the colours of triangles within the frames of a shot.

    Every position becomes a mean of those around it in time, weighted by a Gaussian. The window
    is as wide on one side as on the other: it ends with the shot, and with the life of the vertex
    or triangle. So what moves evenly stays where it is, up to its first and last frame.
    Border vertices stay on their border; where a triangle would fold, vertices are moved less.

    Args:
        sigma: Standard deviation [frames]; 0 leaves everything as it is.
    """

    def __init__(self, sigma: float) -> None:
        self._reach = reach_of(sigma)
        self._weights = np.exp(-0.5 * (np.arange(self._reach + 1) / max(sigma, 1e-9)) ** 2)
        self._window: list[_Frame] = []
        self._done = 0  # frames of the window that were given out

    def add(self, solved: Solved) -> Iterator[Solved]:
        """Take one more frame.

        Args:
            solved: The next one.

        Yields:
            Smooth frames, in order, as far as enough is known.
        """
        if self._reach == 0:
            yield solved
            return
        if self._window and (solved.begins or self._window[-1].solved.shot != solved.shot):
            yield from self.rest()
        self._window.append(self._linked(solved))
        if len(self._window) > self._done + self._reach:
            yield self._next()
        if self._done > self._reach:
            del self._window[0]
            self._done -= 1

    def rest(self) -> Iterator[Solved]:
        """Give out what is left of the shot."""
        while self._done < len(self._window):
            yield self._next()
        self._window, self._done = [], 0

    def _linked(self, solved: Solved) -> _Frame:
        snapshot = solved.snapshot
        mesh = snapshot.mesh
        before = self._window[-1].mesh if self._window else mesh
        colors = with_origins(snapshot.model, snapshot.coefficients, _centres(mesh))
        limits = snapshot.bounds.astype(np.float64)
        links = kept_vertices(before, mesh), kept_triangles(before, mesh)
        return _Frame(solved, colors, limits, *links)

    def _next(self) -> Solved:
        solved = self._window[self._done].solved
        smooth = self._smooth(self._done)
        self._done += 1
        return replace(solved, snapshot=smooth)

    def _smooth(self, place: int) -> Snapshot:
        snapshot = self._window[place].solved.snapshot
        mesh = snapshot.mesh
        steps = self._mean(place, lambda f: f.mesh.vertices, lambda f: f.vertices)
        moved = mesh.moved(mesh.vertices + unfolded(mesh, sliding(mesh, steps)))
        colors = self._window[place].colors
        colors = colors + self._mean(place, lambda f: f.colors, lambda f: f.triangles)
        coefficients = with_origins(snapshot.model, colors, -_centres(moved))
        limits = self._window[place].limits
        limits = limits + self._mean(place, lambda f: f.limits, lambda f: f.triangles)
        return replace(snapshot, mesh=moved, coefficients=coefficients, limits=limits)

    def _mean(
        self,
        place: int,
        values_of: Callable[[_Frame], np.ndarray],
        links_of: Callable[[_Frame], np.ndarray],
    ) -> np.ndarray:
        """How far the weighted means over time are from the values themselves.

        Args:
            place: The frame's place in the window.
            values_of: What is averaged of a frame, [N, ...].
            links_of: For each of these its number in the frame before, or -1; [N].

        Returns:
            Differences, shape [N, ...].
        """
        window = self._window
        values = values_of(window[place])
        alive = earlier = later = np.arange(len(values))
        sums, weights = np.zeros_like(values), np.ones(len(values))
        for j in range(1, min(self._reach, place, len(window) - 1 - place) + 1):
            earlier = links_of(window[place - j + 1])[earlier]
            onward = _reversed(links_of(window[place + j]), len(values_of(window[place + j - 1])))
            later = onward[later]
            both = (earlier >= 0) & (later >= 0)
            alive, earlier, later = alive[both], earlier[both], later[both]
            own = values[alive]
            before, after = (
                values_of(window[place - j])[earlier],
                values_of(window[place + j])[later],
            )
            # Both differences at once: a film that runs backwards gives the same bits.
            sums[alive] += self._weights[j] * ((before - own) + (after - own))
            weights[alive] += 2.0 * self._weights[j]
        return sums / weights.reshape(-1, *[1] * (values.ndim - 1))


def reach_of(sigma: float) -> int:
    """Frames on either side of one that its smooth version depends on.

    Args:
        sigma: Standard deviation [frames].
    """
    return ceil(DEVIATIONS * sigma)


def _centres(mesh: Mesh) -> np.ndarray:
    """Centroids of the triangles [px], shape [T, 2]."""
    return mesh.vertices[mesh.triangles].mean(axis=1)


def _reversed(links: np.ndarray, count: int) -> np.ndarray:
    """Links the other way: for each of `count` numbers which one leads to it, or -1."""
    onward = np.full(count, -1, dtype=np.int64)
    known = np.flatnonzero(links >= 0)
    onward[links[known]] = known
    return onward
