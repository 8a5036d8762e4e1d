"""A fine mesh of the grey height field, simplified by quadric errors: Garland & Heckbert."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.related.detail import luma
from stages.edits import collapse_edges, collapsible, independent_collapses
from stages.layouts.grid import Grid
from stages.mesh import Mesh, areas_of, mesh_of, next_corner

LEAST_HEIGHT = 0.3
"""Collapses that leave a thinner triangle are not done [px]."""


@dataclass(frozen=True)
class QuadricSimplification:
    """Edges of least quadric error collapse until the wanted number of triangles is left.

    Source: Garland & Heckbert, Surface simplification using quadric error metrics (1997), on the
        grey value as height, as Lawonn & Guenther (2018), Sec. 6.1, use it.
    Deviation: many independent collapses at a time, the cheapest first; the place of least error
        is taken where no triangle turns over, else the end of the edge.
    """

    stride: int = 3
    """Pixels between the vertices of the first mesh."""
    height_scale: float = 0.03
    """Height of one code value [px]."""
    fall: float = 0.12
    """Part of the vertices that one round removes at most."""

    def build(self, pixels: np.ndarray, triangle_count: int, rng: np.random.Generator) -> Mesh:
        """Triangulate a picture [H, W, 3] uint8 with about `triangle_count` triangles."""
        height, width = pixels.shape[:2]
        fine = max(2 * (width // self.stride) * (height // self.stride), 2 * triangle_count)
        mesh = Grid().build(pixels, fine, rng)
        z = self.height_scale * _heights(luma(pixels), mesh.vertices)
        places = np.column_stack([mesh.vertices, z])
        quadrics = vertex_quadrics(places[mesh.triangles], mesh.triangles, mesh.vertex_count)
        while mesh.triangle_count > triangle_count + 1:
            excess = (mesh.triangle_count - triangle_count) // 2
            most = max(1, min(excess, int(self.fall * mesh.vertex_count)))
            ids = mesh.vertex_ids
            ranked = _ranked_collapses(mesh, quadrics[ids], places[ids], most)
            if len(ranked) == 0:
                break
            ends = ids[mesh.triangles.reshape(-1)]
            origins, targets = ends[ranked], ends[next_corner(ranked)]
            mesh = collapse_edges(mesh, ranked)
            np.add.at(quadrics, targets, quadrics[origins])
            mesh = _place_best(mesh, np.unique(targets), quadrics, places)
        return mesh_of(mesh.vertices, mesh.triangles, width, height)


def _heights(grey: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Grey values [V] at the vertices [px, V x 2]."""
    last = np.array(grey.shape)[::-1] - 1
    columns, rows = np.clip(np.floor(vertices), 0, last).astype(int).T
    return grey[rows, columns].astype(np.float64)


def vertex_quadrics(corners: np.ndarray, triangles: np.ndarray, count: int) -> np.ndarray:
    """Sum of the squared distances to the planes around each vertex, weighted by area.

    Args:
        corners: Of the surface's triangles [px], [T, 3, 3].
        triangles: Vertex numbers, [T, 3].
        count: Number of vertices V.

    Returns:
        Symmetric matrices, [V, 4, 4].
    """
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    normals /= doubled[:, None]
    planes = np.column_stack([normals, -(normals * corners[:, 0]).sum(axis=1)])
    quadrics = 0.5 * doubled[:, None, None] * planes[:, :, None] * planes[:, None, :]
    sums = np.zeros((count, 4, 4))
    for corner in range(3):
        np.add.at(sums, triangles[:, corner], quadrics)
    return sums


def _ranked_collapses(
    mesh: Mesh, quadrics: np.ndarray, places: np.ndarray, most: int
) -> np.ndarray:
    """The cheapest legal half-edges that do not touch each other, [N <= most].

    Args:
        mesh: The mesh.
        quadrics: Of its vertices, [V, 4, 4].
        places: Of its vertices in space [px], [V, 3].
        most: Collapses wanted.
    """
    half_edges = np.arange(3 * mesh.triangle_count)
    ends = mesh.triangles.reshape(-1)
    origins, targets = ends, ends[next_corner(half_edges)]
    there = np.column_stack([places[targets], np.ones(len(targets))])
    both = quadrics[origins] + quadrics[targets]
    costs = np.einsum("ni,nij,nj->n", there, both, there, optimize=True)
    ranked = np.argsort(costs, kind="stable")[: max(64, 6 * most)]
    ranked = ranked[collapsible(mesh, ranked, LEAST_HEIGHT)]
    return ranked[independent_collapses(mesh, ranked)][:most]


def _place_best(mesh: Mesh, targets: np.ndarray, quadrics: np.ndarray, places: np.ndarray) -> Mesh:
    """Move vertices to where their quadrics are least, as far as no triangle turns over.

    Args:
        mesh: The mesh.
        targets: Ids of the vertices that took others in, ascending, [N].
        quadrics: By vertex id, [.., 4, 4].
        places: By vertex id [px], [.., 3]; changed in place.
    """
    rows = np.searchsorted(mesh.vertex_ids, targets)
    free = ~(mesh.on_left_right | mesh.on_top_bottom)[rows]
    rows, targets = rows[free], targets[free]
    best = best_places(quadrics[targets], places[targets])
    vertices = mesh.vertices.copy()
    vertices[rows, :2] = best[:, :2]
    back = np.zeros(mesh.vertex_count, dtype=bool)
    # putting one vertex back may turn over another's triangle, so look again
    while True:
        thin = areas_of(vertices[mesh.triangles]) < np.minimum(0.5, 0.5 * mesh.areas)
        turned = np.zeros(mesh.vertex_count, dtype=bool)
        turned[mesh.triangles[thin]] = True
        turned &= ~back
        if not turned[rows].any():
            break
        back |= turned
        vertices[back] = mesh.vertices[back]
    kept = ~back[rows]
    places[targets[kept]] = best[kept]
    return mesh.moved(vertices)


def best_places(quadrics: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Where quadrics are least, drawn a little to where the vertices are: planes have no point.

    Args:
        quadrics: Symmetric matrices, [N, 4, 4].
        places: Positions in space [px], [N, 3].
    """
    matrices = quadrics[:, :3, :3]
    weight = 1e-3 * np.trace(matrices, axis1=1, axis2=2)[:, None] + 1e-12
    matrices = matrices + weight[:, :, None] * np.eye(3)
    right = weight * places - quadrics[:, :3, 3]
    return np.linalg.solve(matrices, right[:, :, None])[:, :, 0]
