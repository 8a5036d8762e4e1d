"""Watch the error fall while a picture is triangulated."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from unittest.mock import patch

import numpy as np

from warp_kernels.color_model import CHANNELS
from warp_kernels.energy.workspace import Workspace


@dataclass(frozen=True)
class Moment:
    """The state after some iterations."""

    iterations: int
    """Iterations so far."""
    triangles: int
    """Number of triangles."""
    rmse: float
    """Over pixels and channels [code values]."""


@contextmanager
def watched_iterations() -> Iterator[list[Moment]]:
    """Give a list that gets a moment whenever a workspace has iterated.

    The optimiser asks the workspace for a few iterations at a time; measuring in between reads
    the mesh and changes nothing.
    """
    moments: list[Moment] = []
    iterate = Workspace.iterate

    def iterate_and_measure(workspace: Workspace, times: int, *rest: Any, **named: Any) -> Any:
        """Iterate, then add the moment."""
        result = iterate(workspace, times, *rest, **named)
        energies = workspace.fit()[1]
        samples = CHANNELS * workspace.size[0] * workspace.size[1]
        so_far = moments[-1].iterations if moments else 0
        rmse = float(np.sqrt(2.0 * energies.sum() / samples))
        moments.append(Moment(so_far + times, len(energies), rmse))
        return result

    with patch.object(Workspace, "iterate", iterate_and_measure):
        yield moments
