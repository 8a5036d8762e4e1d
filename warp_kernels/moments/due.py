"""Which edges are to be walked and which triangles to be solved, by marks of their vertices.

Where vertices rest from the beginning nothing need be known of what lies between them. The first
time a free vertex is marked like one that moved, and its neighbours as being beside one: then the
edges among these are walked and the triangles around the free vertex are solved, and no others.
"""

import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

MOVED = 4
"""Mark of a vertex that has moved since the sums around it were taken."""
BESIDE = 1
"""Mark of a resting vertex whose edges to others so marked were not walked yet."""


@wp.func
def edge_is_due(marks: wp.array(dtype=int), ends: wp.vec2i) -> bool:
    """Whether an edge's sums do not stand any more."""
    return marks[ends[0]] + marks[ends[1]] >= 2


@wp.func
def triangle_is_due(marks: wp.array(dtype=int), corners: wp.vec3i) -> bool:
    """Whether a triangle's energies do not stand any more, and the sums of its sides do."""
    return marks[corners[0]] + marks[corners[1]] + marks[corners[2]] >= 3
