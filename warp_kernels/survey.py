"""Device arrays and launches that measure changes of topology over a workspace's mesh."""

from functools import partial
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device import Phase
from warp_kernels.topology_gains import (
    record_collapse_costs,
    record_flip_gains,
    record_split_gains,
)
from warp_kernels.workspace import Workspace


class Survey:
    """Measures all flips, collapses or splits of the mesh in a workspace at once.

    `Workspace.fit` must have run since the vertices moved: gains are differences to its energies.

    Args:
        workspace: Holds the picture and the mesh.
        least_height: Changes that would leave a triangle thinner than this are impossible [px].
    """

    def __init__(self, workspace: Workspace, least_height: float) -> None:
        self._workspace = workspace
        self._least_height = least_height
        self._capacity = 0

    def load_topology(self, twins: np.ndarray, corners: np.ndarray) -> None:
        """Take in what the workspace does not know of its mesh.

        Args:
            twins: The half-edge that runs the other way, -1 on the border, [3 T].
            corners: Vertex number of every half-edge's origin, [3 T].
        """
        device = self._workspace.device
        if len(twins) > self._capacity:
            self._capacity = 3 * self._workspace.capacity[1]
            self._twins = device.empty(self._capacity, int)
            self._corners = device.empty(self._capacity, int)
            self._half_edges = device.empty(self._capacity, int)
            self._gains = device.empty(self._capacity, wp.float64)
        device.write(self._twins, twins)
        device.write(self._corners, corners)

    def flip_gains(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that each flip saves [code value^2 px], [N]; hugely negative if impossible."""
        record = partial(record_flip_gains, twins=self._twins, gains_out=self._gains)
        return self._measure(record, half_edges)

    def collapse_costs(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that each collapse of an origin adds [code value^2 px], [N]; huge if barred."""
        record = partial(
            record_collapse_costs,
            fan_offsets=self._workspace.fan_offsets,
            fan_corners=self._workspace.fan_corners,
            costs_out=self._gains,
        )
        return self._measure(record, half_edges)

    def split_gains(self, half_edges: np.ndarray, share: float = 0.5) -> np.ndarray:
        """Energy that each edge's split saves [code value^2 px], [N]; see `record_split_gains`."""
        record = partial(record_split_gains, twins=self._twins, share=share, gains_out=self._gains)
        return self._measure(record, half_edges)

    def _measure(self, record: Any, half_edges: np.ndarray) -> np.ndarray:
        workspace = self._workspace
        workspace.device.write(self._half_edges, half_edges)
        phase: Phase = record(
            workspace.device,
            workspace.model,
            half_edges=self._half_edges,
            corners=self._corners,
            vertices=workspace.standing,
            energies=workspace.fit_energies,
            table=workspace.table,
            powers=workspace.powers,
            height=workspace.size[1],
            least_height=self._least_height,
        )
        phase.resize(len(half_edges))
        workspace.device.run([phase])
        return workspace.device.read(self._gains, len(half_edges))
