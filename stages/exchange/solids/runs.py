"""Frames of one topology in a row: what a 3D program can take as one mesh that moves."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from stages.exchange.figure import Figure


@dataclass(frozen=True, eq=False)
class MeshPose:
    """How the mesh of a run looks in a frame."""

    frame: int
    """Number of the frame in the source."""
    time: Fraction
    """When it is shown [s from the first frame of the source]."""
    points: np.ndarray
    """Positions, right, up and towards the viewer [px], [N, 3] float32."""
    colors: np.ndarray
    """Linear light of points, triangles or corners, [M, 3] float32."""


@dataclass(frozen=True, eq=False)
class MeshRun:
    """A mesh whose points and colours change, and nothing else."""

    triangles: np.ndarray
    """Points of the corners, counter-clockwise, [T, 3]."""
    poses: list[MeshPose]
    """Frame by frame."""

    @property
    def name(self) -> str:
        """The frames that it shows: `frame_7`, `frames_7_12`."""
        first, last = self.poses[0].frame, self.poses[-1].frame
        return f"frame_{first}" if first == last else f"frames_{first}_{last}"


class MeshRuns:
    """Divides a clip into runs.

    Triangles that come, go or change their corners end a run, and so does a cut: between two frames
    of a run every point goes its way, which would be nonsense across such a change.

    Args:
        most_poses: Poses of a run; a longer one is cut. None for any number.
    """

    def __init__(self, most_poses: int | None) -> None:
        self._most_poses = most_poses
        self.found: list[MeshRun] = []
        """The runs, earliest first."""
        self._key: tuple[int, np.ndarray, np.ndarray] | None = None

    def add(self, figure: Figure, triangles: np.ndarray, pose: MeshPose) -> None:
        """Take a frame.

        Args:
            figure: The frame; later than the one before.
            triangles: Points of the corners, [T, 3].
            pose: How it looks.
        """
        mesh = figure.mesh
        key = (figure.shot, mesh.triangle_ids, mesh.vertex_ids[mesh.triangles])
        if self._goes_on(key) and len(self.found[-1].poses) != self._most_poses:
            self.found[-1].poses.append(pose)
        else:
            self.found.append(MeshRun(triangles, [pose]))
        self._key = key

    def _goes_on(self, key: tuple[int, np.ndarray, np.ndarray]) -> bool:
        if self._key is None:
            return False
        (shot, *before), (now, *after) = self._key, key
        return shot == now and all(map(np.array_equal, before, after))
