"""What appears, vanishes and turns between the meshes of two frames."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from stages.mesh import Mesh
from stages.metrics.numbering import keys_of, numbers_of


@dataclass(frozen=True)
class MeshChanges:
    """Changes of topology from one frame to the next."""

    births: int
    """Vertices that were not there before."""
    deaths: int
    """Vertices that are not there any more."""
    flips: int
    """Edges that were exchanged: both ends live on, and no new vertex lies between them."""


def mesh_changes(before: Mesh, after: Mesh) -> MeshChanges:
    """Compare two meshes by the ids of their vertices.

    Args:
        before: A frame's mesh.
        after: The next frame's, whose ids go on from there.
    """
    births = np.isin(after.vertex_ids, before.vertex_ids, assume_unique=True, invert=True)
    deaths = np.isin(before.vertex_ids, after.vertex_ids, assume_unique=True, invert=True)
    return MeshChanges(int(births.sum()), int(deaths.sum()), _flips(before, after, births, deaths))


def _flips(before: Mesh, after: Mesh, born: np.ndarray, dead: np.ndarray) -> int:
    """Edges of `before` that are gone though their ends live on and nothing was born there."""
    first, second, count = numbers_of(before, after)
    edges, kept = first[before.edge_vertices], second[after.edge_vertices]
    gone = ~np.isin(keys_of(edges, count), keys_of(kept, count), assume_unique=True)
    gone &= ~dead[before.edge_vertices].any(axis=1)
    # A vertex put into an edge ends it as well; both ends are its neighbours.
    beside = _neighbours(kept, np.isin(np.arange(count), second[born]), count)
    split = beside[edges[gone, 0]].multiply(beside[edges[gone, 1]]).sum(axis=1)
    return int(np.count_nonzero(split == 0))


def _neighbours(edges: np.ndarray, wanted: np.ndarray, count: int) -> csr_array:
    """Which vertices (rows) an edge joins to which wanted vertices (columns), [count, count]."""
    both = np.concatenate([edges, edges[:, ::-1]])
    both = both[wanted[both[:, 1]]]
    ones = np.ones(len(both), dtype=np.int32)
    return csr_array((ones, (both[:, 0], both[:, 1])), shape=(count, count))
