"""A kernel that looks at every triangle of the mesh as it stands in a workspace."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from warp_kernels.device.phase import Phase
from warp_kernels.device.staging import ArrayRows
from warp_kernels.energy.workspace import Workspace


@dataclass(frozen=True)
class Column:
    """What a look is given or finds, a row for every triangle."""

    dtype: Any
    """Warp's type of an element."""
    shape: tuple[int, ...] = ()
    """Shape of a row."""


class TriangleLook:
    """Memory for what a kernel is given and finds, and its recorded launches.

    Args:
        workspace: Holds the picture and the mesh.
        kernel: Takes a span of triangles, the vertices that stand, the corners, `fixed`, `given`
            and what is found, in this order.
        fixed: Arguments that never change, such as the picture.
        given: What is written before each look.
        found: What is read after it.
    """

    def __init__(
        self,
        workspace: Workspace,
        kernel: Any,
        *,
        fixed: Sequence[Any],
        given: Sequence[Column] = (),
        found: Sequence[Column],
    ) -> None:
        self._workspace, self._kernel, self._fixed = workspace, kernel, tuple(fixed)
        self._columns = (tuple(given), tuple(found))
        self._given: list[wp.array] = []
        self._found: list[wp.array] = []
        self._generation = -1
        self._recorded: dict[int, Phase] = {}

    def look(
        self, count: int, values: Sequence[np.ndarray] = (), first: Sequence[Phase] = ()
    ) -> list[np.ndarray]:
        """Look at the mesh as it stands.

        Args:
            count: Its number of triangles T.
            values: What is given, a row for each, [T, ...].
            first: What is run before, in the same go.

        Returns:
            What was found, a row for each, [T, ...].
        """
        self._allocate()
        device = self._workspace.device
        for array, rows in zip(self._given, values, strict=True):
            device.write(array, rows)
        phase = self._phase()
        phase.resize(count)
        device.run([*first, phase])
        return device.read_all([ArrayRows(array, count) for array in self._found])

    def _allocate(self) -> None:
        """Take memory for as many triangles as the workspace has room for."""
        workspace = self._workspace
        if self._generation == workspace.generation:
            return
        room = workspace.capacity[1]
        self._given, self._found = (
            [workspace.device.empty((room, *column.shape), column.dtype) for column in columns]
            for columns in self._columns
        )
        self._generation = workspace.generation
        self._recorded.clear()

    def _phase(self) -> Phase:
        """The launch over the vertices that stand: iterations leave them in one of two places."""
        workspace = self._workspace
        place = workspace.standing.ptr
        if place not in self._recorded:
            inputs = [workspace.standing, workspace.triangles, *self._fixed, *self._given]
            self._recorded[place] = workspace.device.record(self._kernel, inputs, self._found)
        return self._recorded[place]
