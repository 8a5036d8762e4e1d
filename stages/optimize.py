"""Move the vertices of a mesh so that the picture is approximated best."""

from dataclasses import dataclass, field

import numpy as np

from stages.mesh import Mesh
from warp_kernels.workspace import Workspace


@dataclass(frozen=True)
class OptimizeOptions:
    """How vertices move."""

    regularity: float = field(
        default=1e-3, metadata={"help": "lambda: pull towards the ring's centre"}
    )
    trust_region: float = field(
        default=0.5, metadata={"help": "longest step of a vertex in one iteration [px]"}
    )


def load_mesh(
    workspace: Workspace, mesh: Mesh, anchors: np.ndarray | None = None, pull: float = 0.0
) -> None:
    """Put a mesh into device memory.

    Args:
        workspace: Takes the mesh.
        mesh: The mesh.
        anchors: Where the temporal term holds each vertex [px], [V, 2]; else nowhere.
        pull: Weight of the temporal term [code value^2].
    """
    freedom = np.stack([~mesh.on_left_right, ~mesh.on_top_bottom], axis=1).astype(np.float64)
    springs = np.zeros((mesh.vertex_count, 3))
    if anchors is not None:
        springs[:, :2] = anchors
        springs[:, 2] = pull
    workspace.load_mesh(
        vertices=mesh.vertices,
        triangles=mesh.triangles,
        edges=mesh.edge_vertices,
        sides=(2 * mesh.half_edge_to_edge + mesh.half_edge_reversed).reshape(-1, 3),
        fan_offsets=mesh.fan_offsets,
        fan_corners=mesh.fan_corners,
        freedom=freedom,
        anchors=springs,
    )


def optimize(
    workspace: Workspace,
    mesh: Mesh,
    iterations: int,
    options: OptimizeOptions,
    *,
    trust_region: float | None = None,
) -> Mesh:
    """Run iterations of gradient descent over the mesh that lies in the workspace.

    Args:
        workspace: Holds the picture and `mesh` (see `load_mesh`); its vertices move.
        mesh: The mesh in the workspace, whose topology the result shares.
        iterations: Number of steps of every vertex.
        options: How vertices move.
        trust_region: Longest step [px], if not that of `options`.

    Returns:
        The same triangles over the new positions.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 3.2.
    """
    trust = options.trust_region if trust_region is None else trust_region
    workspace.iterate(iterations, trust=trust, regularity=options.regularity)
    return mesh.moved(workspace.vertices())
