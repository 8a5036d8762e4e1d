"""How many triangles of a frame were not there in the frame before."""

import numpy as np

from stages.mesh import Mesh
from stages.metrics.numbering import keys_of, numbers_of


def changed_triangles(before: Mesh, after: Mesh) -> int:
    """Count triangles between vertices that no triangle joined before: born, turned or rewired.

    Args:
        before: A frame's mesh.
        after: The next frame's, whose ids go on from there.
    """
    if after.triangles is before.triangles and after.vertex_ids is before.vertex_ids:
        return 0  # it only moved, as most of a calm shot does
    first, second, count = numbers_of(before, after)
    old, new = keys_of(first[before.triangles], count), keys_of(second[after.triangles], count)
    return int(np.isin(new, old, assume_unique=True, invert=True).sum())
