"""Device arrays and launches that measure changes of topology over a workspace's mesh."""

import numpy as np
import warp as wp

from warp_kernels.device.phase import Phase
from warp_kernels.device.staging import ArrayRows
from warp_kernels.energy.card_splits import TRIED, record_card_splits
from warp_kernels.energy.topology_gains import record_changes
from warp_kernels.energy.topology_inputs import ground_type
from warp_kernels.energy.workspace import Workspace

CHANGES = ("flip", "collapse", "split")


class Survey:
    """Measures all flips, collapses or splits of the mesh in a workspace at once.

    `Workspace.fit` must have run since the vertices moved: gains are differences to its energies.
    On the CPU the half-edges that are asked for are measured. On a card, where a copy takes longer
    than to measure all, all changes of all half-edges are measured and read together.

    Args:
        workspace: Holds the picture and the mesh.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._measures_all = workspace.device.is_cuda
        self._known: dict[str, list[np.ndarray]] = {}
        self._limited: tuple[float, float] | None = None
        self._limits = workspace.device.empty(2, wp.float64)
        self.limit(0.0, np.inf)
        self._capacity = 0
        self._phases: dict[tuple[str, int, int], tuple[Phase, ...]] = {}

    def limit(self, least_height: float, largest_area: float) -> None:
        """Bar changes that would make a triangle thinner [px] or larger [px^2] than this."""
        if self._limited != (least_height, largest_area):
            self._limited = (least_height, largest_area)
            self._known.clear()
            self._workspace.device.write(self._limits, np.array([least_height, largest_area]))

    def load_topology(self, twins: np.ndarray, corners: np.ndarray) -> None:
        """Take in what the workspace does not know of its mesh.

        Args:
            twins: The half-edge that runs the other way, -1 on the border, [3 T].
            corners: Vertex number of every half-edge's origin, [3 T].
        """
        self._known.clear()
        self._count = len(twins)
        device = self._workspace.device
        if len(twins) > self._capacity:
            self._capacity = 3 * self._workspace.capacity[1]
            self._phases.clear()  # they were recorded over the arrays that go now
            self._twins = device.empty(self._capacity, int)
            self._corners = device.empty(self._capacity, int)
            self._half_edges = device.empty(self._capacity, int)
            self._changes = {name: device.empty(self._capacity, wp.float64) for name in CHANGES}
            self._points = device.empty(self._capacity, wp.vec2d)
            if self._measures_all:
                self._trials = device.empty(self._capacity * TRIED, wp.float64)
                device.write(self._half_edges, np.arange(self._capacity))
        device.write(self._twins, twins)
        device.write(self._corners, corners)

    def flip_gains(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that each flip saves [code value^2 px], [N]; hugely negative if impossible."""
        (gains,) = self._measure("flip", half_edges)
        return gains

    def collapse_costs(self, half_edges: np.ndarray) -> np.ndarray:
        """Energy that each collapse of an origin adds [code value^2 px], [N]; huge if barred."""
        (costs,) = self._measure("collapse", half_edges)
        return costs

    def split_gains(self, half_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The best split of each edge.

        Returns:
            Energy that it saves [code value^2 px], [N], and its place [px], [N, 2].
        """
        gains, points = self._measure("split", half_edges)
        return gains, points

    def _measure(self, change: str, half_edges: np.ndarray) -> list[np.ndarray]:
        """Look at half-edges, and read what was found of each."""
        if self._measures_all:
            if not self._known:
                self._measure_all()
            return [found[half_edges] for found in self._known[change]]
        device = self._workspace.device
        device.write(self._half_edges, half_edges)
        device.run(self._launches(change, len(half_edges)))
        return device.read_all([ArrayRows(found, len(half_edges)) for found in self._found(change)])

    def _measure_all(self) -> None:
        """Look at every half-edge for every change."""
        device = self._workspace.device
        launches = (self._launches(change, self._count) for change in CHANGES)
        device.run([phase for phases in launches for phase in phases])
        arrays = [found for change in CHANGES for found in self._found(change)]
        read = iter(device.read_all([ArrayRows(array, self._count) for array in arrays]))
        self._known = {change: [next(read) for _ in self._found(change)] for change in CHANGES}

    def _launches(self, change: str, count: int) -> tuple[Phase, ...]:
        """What measures so many half-edges."""
        key = (change, self._workspace.generation, self._workspace.standing.ptr)
        if key not in self._phases:
            self._phases[key] = self._record(change)
        for phase in self._phases[key]:
            phase.resize(count)
        return self._phases[key]

    def _record(self, change: str) -> tuple[Phase, ...]:
        workspace = self._workspace
        ground = ground_type(workspace.layout)()
        ground.half_edges = self._half_edges
        ground.twins = self._twins
        ground.corners = self._corners
        ground.vertices = workspace.standing
        ground.energies = workspace.fit_energies
        ground.sides = workspace.sides
        ground.color_sums = workspace.fit_color_sums
        ground.area_sums = workspace.fit_area_sums
        ground.table = workspace.table
        ground.gauge = workspace.gauge
        ground.limits = self._limits
        ground.width, ground.height = workspace.size
        found = self._found(change)
        if change == "split" and self._measures_all:
            gains, points = found
            return record_card_splits(
                workspace.device,
                workspace.layout,
                ground,
                trials_out=self._trials,
                gains_out=gains,
                points_out=points,
            )
        return (record_changes(workspace.device, workspace.layout, change, ground, found),)

    def _found(self, change: str) -> list[wp.array]:
        """What is found of a change: for splits their places as well."""
        return [self._changes[change], *([self._points] if change == "split" else [])]
