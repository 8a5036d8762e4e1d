"""Which triangles belong to regions that were painted, in any frame."""

from dataclasses import replace

import numpy as np

from pipeline.editor.bench.film import SolvedFilm
from pipeline.look.region_masks import own_mask
from pipeline.look.region_members import MEMBER
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from stages.masks.area import Area
from stages.masks.region import Region
from stages.motion.inherit_regions import under_mask
from stages.snapshot import Snapshot

EVERYWHERE = Area(radius=np.inf)
"""All triangles of all frames: nobody can point at it."""


class Members:
    """Follows regions through their shots, each once.

    Args:
        film: The frames.
        options: How they were solved.
    """

    def __init__(self, film: SolvedFilm, options: SolveOptions) -> None:
        self._film, self._options = film, options
        self._known: dict[Region, dict[int, np.ndarray]] = {}

    def shares(
        self, look: Look, frame: int, snapshot: Snapshot, *, is_edited: bool
    ) -> np.ndarray | None:
        """Which of the followed regions of a look the triangles of a frame belong to.

        Args:
            look: The look.
            frame: Number of the frame.
            snapshot: What is shown of it.
            is_edited: Whether that is what edits leave, and not a frame of the film.

        Returns:
            See `Paint.shares`, [T, R] uint8; None if the look follows no region.
        """
        columns = [self._column(r, frame, snapshot, is_edited) for r in look.followed]
        return MEMBER * np.stack(columns, axis=1).astype(np.uint8) if columns else None

    def _column(
        self, region: Region, frame: int, snapshot: Snapshot, is_edited: bool
    ) -> np.ndarray:
        """Whether triangles belong to one region, [T] bool."""
        mesh = snapshot.mesh
        if region.areas == (EVERYWHERE,):
            return np.ones(mesh.triangle_count, dtype=bool)
        if is_edited and frame in region.frames:
            return under_mask(mesh, own_mask(region, frame, (mesh.width, mesh.height)))
        if region not in self._known:
            self._known[region] = self._followed(region)
        found = self._known[region].get(frame)
        if found is None or len(found) != mesh.triangle_count:
            return np.zeros(mesh.triangle_count, dtype=bool)  # of edits that are not applied yet
        return found

    def _followed(self, region: Region) -> dict[int, np.ndarray]:
        """The members of a region in all frames of the film's shots that it is in."""
        look = replace(Look(), regions=(region,))
        return self._film.followed(look, self._options, region.frames)
