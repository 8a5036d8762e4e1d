"""Move the vertices of a mesh so that the picture is approximated best."""

import numpy as np

from stages.mesh import Mesh
from stages.optimize_options import OptimizeOptions
from warp_kernels.energy.workspace import DISPLACEMENT, Workspace
from warp_kernels.moments.due import BESIDE, MOVED

PROBE = 0.12
"""Variants are displaced by no more than this part of the side of a square as large as a mean
triangle: wider ones look past small triangles."""


def probe_of(mesh: Mesh, widest: float) -> float:
    """How far the variants that give the slope are displaced [px].

    Args:
        mesh: Tells how large triangles are.
        widest: Where triangles are large [px].
    """
    return min(widest, PROBE * float(np.sqrt(mesh.width * mesh.height / mesh.triangle_count)))


def load_mesh(
    workspace: Workspace,
    mesh: Mesh,
    springs: np.ndarray | None = None,
    free: np.ndarray | None = None,
) -> None:
    """Put a mesh into device memory, where `optimize` starts from it.

    Args:
        workspace: Takes the mesh.
        mesh: The mesh.
        springs: Where the temporal term holds each vertex [px], how strongly [code value^2],
            and the shortest step by which it leaves that place [px], [V, 4]; None for not at
            all.
        free: Vertices that move; the others rest, and cost nothing, [V] bool. None for all.
    """
    place_mesh(workspace, mesh)
    anchors = np.zeros((mesh.vertex_count, 4)) if springs is None else springs
    workspace.hold(anchors, None if free is None else _marks(mesh, free))


def _marks(mesh: Mesh, free: np.ndarray) -> np.ndarray:
    """What `Freedom.rest` asks for, shape [V] int32."""
    marks = np.zeros(mesh.vertex_count, dtype=np.int32)
    marks[mesh.triangles[free[mesh.triangles].any(axis=1)]] = BESIDE
    marks[free] = MOVED
    return marks


def place_mesh(workspace: Workspace, mesh: Mesh) -> None:
    """Put a mesh into device memory, unless it lies there already, to be measured.

    Args:
        workspace: Takes the mesh.
        mesh: The mesh.
    """
    if workspace.placed is mesh:
        return
    freedom = np.stack([~mesh.on_left_right, ~mesh.on_top_bottom], axis=1).astype(np.float64)
    workspace.load_mesh(
        vertices=mesh.vertices,
        triangles=mesh.triangles,
        edges=mesh.edge_vertices,
        sides=(2 * mesh.half_edge_to_edge + mesh.half_edge_reversed).reshape(-1, 3),
        fan_offsets=mesh.fan_offsets,
        fan_corners=mesh.fan_corners,
        freedom=freedom,
    )
    workspace.placed = mesh


def optimize(
    workspace: Workspace,
    mesh: Mesh,
    iterations: int,
    options: OptimizeOptions,
    *,
    trust_region: float | None = None,
    dead_band: float = 0.0,
    displacement: float = DISPLACEMENT,
) -> Mesh:
    """Run iterations of gradient descent over the mesh that lies in the workspace.

    Args:
        workspace: Holds the picture and `mesh` (see `load_mesh`); its vertices move.
        mesh: The mesh in the workspace, whose topology the result shares.
        iterations: Number of steps of every vertex.
        options: How vertices move.
        trust_region: Longest step [px], if not that of `options`.
        dead_band: Shorter steps are not taken [px].
        displacement: Distance of the variants that give the slope [px].

    Returns:
        The same triangles over the new positions.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.2.
    """
    trust = options.trust_region if trust_region is None else trust_region
    workspace.iterate(
        iterations,
        trust=trust,
        regularity=options.regularity,
        dead_band=dead_band,
        displacement=displacement,
    )
    workspace.placed = mesh.moved(workspace.vertices())
    return workspace.placed
