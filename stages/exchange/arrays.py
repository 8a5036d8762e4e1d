"""NumPy: all that is known of every frame, as arrays that a notebook reads in one line."""

from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format

SCHEMA = 1
"""Version of what `docs/exchange.md` says of the arrays; names are only ever added to one."""
ANY = ("flat", "gradient")
"""Styles that are no more than the colours."""


class Arrays(Format):
    """All frames in one file; what a frame has lies between two offsets."""

    styles: ClassVar[tuple[str, ...]] = ANY

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._frames: list[tuple[int, float, int]] = []
        self._parts: dict[str, list[np.ndarray]] = {}

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        mesh, snapshot = figure.mesh, figure.snapshot
        self._frames.append((figure.index, float(figure.time), figure.shot))
        for name, array in {
            "vertices": mesh.vertices,
            "vertex_ids": mesh.vertex_ids,
            "triangles": mesh.triangles,
            "triangle_ids": mesh.triangle_ids,
            "colors": figure.colors,
            "coefficients": snapshot.coefficients,
            "energies": snapshot.energies,
            "counts": snapshot.counts,
        }.items():
            self._parts.setdefault(name, []).append(array)

    def save(self, path: Path) -> None:
        """Write them."""
        frames, times, shots = zip(*self._frames, strict=True)
        offsets = {
            name: np.cumsum([0, *(len(part) for part in self._parts[table])])
            for name, table in (("vertex_offsets", "vertices"), ("triangle_offsets", "triangles"))
        }
        arrays: dict[str, Any] = {
            "schema": np.int64(SCHEMA),
            "size": np.array(self.film.size),
            "frames": np.array(frames),
            "times": np.array(times),
            "shots": np.array(shots),
            **offsets,
            **{name: np.concatenate(parts) for name, parts in self._parts.items()},
        }
        with path.open("wb") as file:
            np.savez_compressed(file, **arrays)
