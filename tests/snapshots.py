"""Snapshots and shots made by hand."""

from fractions import Fraction

import numpy as np

from stages.edits import (
    collapse_edges,
    collapsible,
    flip_edges,
    flippable,
    independent_collapses,
    independent_flips,
    split_triangles,
)
from stages.mesh import Mesh
from stages.snapshot import Snapshot
from warp_kernels.color_model import CONSTANT, ColorModel


def snapshot_with(
    mesh: Mesh, coefficients: np.ndarray, index: int = 0, model: ColorModel = CONSTANT
) -> Snapshot:
    """A snapshot in chosen colours: [T, 3] if they are constant, else coefficients [T, 3, K]."""
    values = np.asarray(coefficients, dtype=np.float64)
    count = mesh.triangle_count
    return Snapshot(
        frame_index=index,
        pts=index,
        time_base=Fraction(1, 25),
        mesh=mesh,
        model=model,
        coefficients=values.reshape(count, 3, model.term_count),
        energies=np.zeros(count),
        counts=np.ones(count, dtype=np.int64),
    )


def restless_shot(mesh: Mesh, count: int, seed: int = 5) -> list[Snapshot]:
    """Frames that flip, split, collapse, move and change colour all the time."""
    rng = np.random.default_rng(seed)
    shot = []
    for index in range(count):
        shot.append(snapshot_with(mesh, rng.integers(0, 256, (mesh.triangle_count, 3)), index))
        mesh = edited(mesh, rng)
    return shot


def edited(mesh: Mesh, rng: np.random.Generator) -> Mesh:
    """A mesh after some edits of every kind and a small move of its inner vertices."""
    edges = rng.permutation(mesh.edge_half_edges)
    edges = edges[flippable(mesh, edges, min_height=0.2)]
    mesh = flip_edges(mesh, edges[independent_flips(mesh, edges)][:4])
    mesh = split_triangles(mesh, rng.permutation(mesh.triangle_count)[:4])
    edges = rng.permutation(mesh.edge_half_edges)
    edges = edges[collapsible(mesh, edges, min_height=0.2)]
    mesh = collapse_edges(mesh, edges[independent_collapses(mesh, edges)][:4])
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    step = 0.02 * rng.standard_normal(mesh.vertices.shape) * inner[:, None]
    moved = mesh.moved(mesh.vertices + step)
    return moved if moved.heights.min() > 0.02 else mesh
