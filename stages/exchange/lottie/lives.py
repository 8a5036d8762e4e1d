"""Lives of triangles: frames in a row in which one keeps its corners."""

from dataclasses import dataclass

import numpy as np

from stages.exchange.figure import Figure


@dataclass(frozen=True, eq=False)
class Life:
    """A triangle from the frame in which it comes to the last one that has it."""

    triangle: int
    """Its number."""
    first: int
    """The frame in which it comes, counted among those written."""
    corners: np.ndarray
    """Positions, frame by frame [px], [N, 3, 2] float64."""
    colors: np.ndarray
    """Colours, frame by frame [code values], [N, 3] uint8."""

    @property
    def end(self) -> int:
        """The frame after its last one."""
        return self.first + len(self.corners)


class Lives:
    """Collects frames and divides them into lives.

    A life ends where a triangle goes, where it has other corners, as after a flip, and at a cut: in
    between its corners go their way, which would be nonsense across such a change.
    """

    def __init__(self) -> None:
        self._rows: list[np.ndarray] = []
        self._corners: list[np.ndarray] = []
        self._colors: list[np.ndarray] = []

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        mesh = figure.mesh
        told = np.full((mesh.triangle_count, 1), figure.shot), mesh.triangle_ids[:, None]
        frame = np.full((mesh.triangle_count, 1), len(self._rows))
        self._rows.append(np.hstack([*told, mesh.vertex_ids[mesh.triangles], frame]))
        self._corners.append(mesh.corners)
        self._colors.append(figure.colors)

    def found(self) -> list[Life]:
        """The lives, those that end last first; then by first frame and number."""
        rows, corners = np.concatenate(self._rows), np.concatenate(self._corners)
        colors = np.concatenate(self._colors)
        order = np.lexsort(rows.T[::-1])
        rows = rows[order]
        goes_on = (rows[1:, :5] == rows[:-1, :5]).all(axis=1) & (rows[1:, 5] == rows[:-1, 5] + 1)
        parts = np.split(order, np.flatnonzero(~goes_on) + 1)
        begins = rows[np.concatenate([[0], np.flatnonzero(~goes_on) + 1])]
        lives = [
            Life(int(begin[1]), int(begin[5]), corners[part], colors[part])
            for begin, part in zip(begins, parts, strict=True)
        ]
        return sorted(lives, key=lambda life: (-life.end, life.first, life.triangle))
