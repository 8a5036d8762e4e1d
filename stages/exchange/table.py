"""CSV: one row for each triangle of each frame."""

from pathlib import Path
from typing import ClassVar

import numpy as np

from stages.exchange.arrays import ANY
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format

COLUMNS = (
    ("frame", "%d"),
    ("time", "%.9g"),
    ("shot", "%d"),
    ("triangle", "%d"),
    *((f"vertex{corner}", "%d") for corner in range(3)),
    *((f"{axis}{corner}", "%.17g") for corner in range(3) for axis in "xy"),
    *((name, "%d") for name in ("red", "green", "blue")),
)
"""Names and forms; later versions add theirs behind these."""


class Table(Format):
    """All frames in one file."""

    styles: ClassVar[tuple[str, ...]] = ANY

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._rows: list[str] = []

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        mesh = figure.mesh
        count = mesh.triangle_count
        told = np.tile([figure.index, float(figure.time), figure.shot], (count, 1))
        columns = (
            told,
            mesh.triangle_ids[:, None],
            mesh.vertex_ids[mesh.triangles],
            mesh.corners.reshape(-1, 6),
            figure.colors,
        )
        row = ",".join(form for _, form in COLUMNS) + "\n"
        self._rows.append((row * count) % tuple(np.concatenate(columns, axis=1).ravel().tolist()))

    def save(self, path: Path) -> None:
        """Write them."""
        header = ",".join(name for name, _ in COLUMNS)
        path.write_text(f"{header}\n{''.join(self._rows)}", "utf-8", newline="\n")
