"""How coherent two frames are: one measure a file, each of two frames of one shot.

Motion is always that of the source: an output that does not move with its source is to be found
out, not followed.
"""

from stages.metrics.drift import Drift, drift, jitter
from stages.metrics.mesh_changes import MeshChanges, mesh_changes
from stages.metrics.motion import SourceMotion
from stages.metrics.motion_difference import motion_difference
from stages.metrics.pop_energy import pop_energy
from stages.metrics.signature import Signature, change, likeness, signature
from stages.metrics.warp_error import warp_error

__all__ = [
    "Drift",
    "MeshChanges",
    "Signature",
    "SourceMotion",
    "change",
    "drift",
    "jitter",
    "likeness",
    "mesh_changes",
    "motion_difference",
    "pop_energy",
    "signature",
    "warp_error",
]
