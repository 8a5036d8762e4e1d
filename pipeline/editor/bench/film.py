"""The frames that a track holds, and those that it held before any edit."""

from pathlib import Path

import numpy as np

from pipeline.editor.bench.errands import Shots, ground_of
from pipeline.look.region_members import followed_shares
from pipeline.options.edit_log import EditLog
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from pipeline.track import TrackReader
from stages.hand import DRAWN, EDITS
from stages.media import MediaInfo
from stages.snapshot import Snapshot
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import TrackError


class SolvedFilm:
    """A track, as it is now.

    Args:
        path: Its file.

    Raises:
        TrackError: If it holds no frame, or is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._reader = TrackReader(path)
        if not self._reader.rows:
            self._reader.close()
            raise TrackError(f"{path}: holds no frame yet; solve it again")
        self._rows = {row.frame: row for row in self._reader.rows}
        self.solved_with: EditLog = self._reader.header.solve.edits or EditLog()
        """The edits with which its frames were solved."""
        self._ground = self._kept(ground_of(path)) if self.solved_with.edits else None

    def _kept(self, path: Path) -> TrackReader | None:
        """The same track before any edit, if it was kept."""
        if not path.exists():
            return None
        try:
            kept = TrackReader(path)
        except TrackError:
            return None
        mine, others = self._reader.header, kept.header
        ways = [{**h.options, "edits": None, "source": None} for h in (mine, others)]
        is_same = mine.source.digest == others.source.digest and ways[0] == ways[1]
        if is_same and not (others.solve.edits or EditLog()).edits:
            return kept
        kept.close()
        return None

    def __contains__(self, frame: object) -> bool:
        return frame in self._rows

    @property
    def info(self) -> MediaInfo:
        """The source."""
        return self._reader.header.info

    @property
    def model(self) -> ColorModel:
        """The colour model of its snapshots."""
        return self._reader.header.model

    @property
    def frames(self) -> list[int]:
        """Numbers of its frames, ascending."""
        return list(self._rows)

    @property
    def shots(self) -> list[Shots]:
        """Its shots, in order."""
        found: dict[int, Shots] = {}
        for row in self._rows.values():
            found[row.shot] = Shots(
                found[row.shot].first if row.shot in found else row.frame, row.frame
            )
        return list(found.values())

    @property
    def has_ground(self) -> bool:
        """Whether the frames before any edit are known."""
        return self._ground is not None or not self.solved_with.edits

    def pending(self, log: EditLog) -> list[Shots]:
        """Shots whose meshes were not yet solved with the edits in force.

        Args:
            log: Those.
        """
        now, then = _of_meshes(log), _of_meshes(self.solved_with)
        return [shots for shots in self.shots if shots.log(now) != shots.log(then)]

    def snapshot(self, frame: int, *, before: bool = False) -> Snapshot:
        """What a frame became.

        Args:
            frame: Its number.
            before: Whether before any edit, where that is known.

        Raises:
            TrackError: If the track is damaged.
        """
        reader = self._ground if before and self._ground is not None else self._reader
        return reader.snapshot(frame)

    def followed(
        self, look: Look, options: SolveOptions, frames: tuple[int, ...]
    ) -> dict[int, np.ndarray]:
        """The triangles of the one region of a look, by frame, in the shots of some frames.

        Args:
            look: Has the region.
            options: How the frames were solved.
            frames: Those for which the region was painted.
        """
        shots = {self._rows[frame].shot for frame in frames}
        rows = [row for row in self._rows.values() if row.shot in shots]
        shares = followed_shares(options, look, self._reader, rows)
        found = zip(rows, shares, strict=True)
        return {row.frame: share[:, 0] > 0 for row, share in found if share is not None}

    def time(self, frame: int) -> float:
        """When a frame is shown [s from the first one]."""
        return float(self._rows[frame].pts * self.info.time_base - self.info.start_time)

    def close(self) -> None:
        """Release the files."""
        self._reader.close()
        if self._ground is not None:
            self._ground.close()


def _of_meshes(log: EditLog) -> EditLog:
    """A log without what is only drawn."""
    return EditLog(tuple(e for e in log.edits if EDITS.name_of(type(e)) not in DRAWN))
