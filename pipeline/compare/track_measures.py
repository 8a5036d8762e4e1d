"""What a track says about coherence: its meshes, two frames at a time."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from pipeline.compare.coherence import mean_of
from pipeline.compare.lifetimes import Lifetimes
from pipeline.track import TrackReader
from stages.media import MediaInfo
from stages.metrics.drift import Drift, drift, jitter
from stages.metrics.mesh_changes import mesh_changes
from stages.metrics.motion import SourceMotion
from stages.metrics.pop_energy import pop_energy
from stages.snapshot import Snapshot
from warp_kernels.errors import TrackError


@dataclass(frozen=True)
class MeshFigures:
    """How a frame's mesh differs from that of the frame before; None where a shot begins."""

    births: int | None
    """Vertices that came."""
    deaths: int | None
    """Vertices that went."""
    flips: int | None
    """Edges that were exchanged."""
    jitter: float | None
    """Mean second difference of the vertices' paths beside the source's motion [px]."""
    pop_energy: float | None
    """Mean squared change of colour by what came and went, colours in [0, 1]."""
    inverted: int
    """Triangles of this frame without a positive area."""


@dataclass(frozen=True)
class TrackFigures:
    """Figures of all frames of a track."""

    births: float | None
    """Vertices that came, per step from frame to frame."""
    deaths: float | None
    """Vertices that went, per step."""
    flips: float | None
    """Edges that were exchanged, per step."""
    median_life: float | None
    """Median number of frames that a triangle lives; the clip's ends cut lives short."""
    jitter: float | None
    """Mean over the frames [px]."""
    pop_energy: float | None
    """Mean over the steps, colours in [0, 1]."""
    inverted: int
    """Triangles without a positive area, in all frames together."""


class TrackMeter:
    """Compares every mesh of a track with the one before.

    Args:
        track: The track.
        source: What the output is compared with.

    Raises:
        TrackError: If the track was made from another source.
        MediaError: If the source cannot be read.
    """

    def __init__(self, track: TrackReader, source: Path) -> None:
        self._track = track
        self._source = source
        track.header.source.check(source)
        self._rows = {row.frame: row for row in track.rows}
        self._is_linked = not track.header.solve.independent
        self._before: Snapshot | None = None
        self._shot: int | None = None
        self._drift: Drift | None = None
        self._lifetimes = Lifetimes()

    def check_size(self, info: MediaInfo) -> None:
        """Refuse a source whose frames have another size than the meshes.

        Raises:
            TrackError: If they have.
        """
        own = self._track.header.info
        if (info.width, info.height) != (own.width, own.height):
            raise TrackError(
                f"{self._track.path}: its meshes are {own.width}x{own.height}, {self._source} is "
                f"{info.width}x{info.height}; name the track of this source"
            )

    def shot_of(self, frame: int) -> int:
        """Number of the frame with which a frame's shot begins.

        Raises:
            TrackError: If the track does not hold the frame.
        """
        row = self._rows.get(frame)
        if row is None:
            held = f"{min(self._rows)} to {max(self._rows)}" if self._rows else "none"
            raise TrackError(
                f"{self._track.path}: holds no frame {frame} (frames: {held}), which "
                f"{self._source} shows; name the track of this output, or its --frames"
            )
        return row.shot

    def add(self, frame: int, motion: SourceMotion | None) -> MeshFigures:
        """Compare the mesh of the next frame.

        Args:
            frame: Its number in the source.
            motion: Motion of the source from the frame before, if of the same shot.
        """
        snapshot = self._track.snapshot(frame)
        shot = self.shot_of(frame)
        before = self._before if shot == self._shot else None
        self._lifetimes.add(
            snapshot.mesh.triangle_ids, goes_on=self._is_linked and before is not None
        )
        inverted = int(np.count_nonzero(snapshot.mesh.areas <= 0))
        figures = MeshFigures(None, None, None, None, None, inverted)
        last, self._drift = self._drift, None
        if before is not None and motion is not None:
            after = snapshot if self._is_linked else _unrelated(snapshot, before)
            self._drift = drift(before.mesh, after.mesh, motion.forward)
            figures = MeshFigures(
                **asdict(mesh_changes(before.mesh, after.mesh)),
                jitter=None if last is None else jitter(last, self._drift),
                pop_energy=pop_energy(before, after, motion),
                inverted=inverted,
            )
        self._before, self._shot = snapshot, shot
        return figures

    def total(self, frames: Sequence[MeshFigures]) -> TrackFigures:
        """Figures of all frames that were added.

        Args:
            frames: What `add` gave.
        """
        return TrackFigures(
            births=mean_of(frame.births for frame in frames),
            deaths=mean_of(frame.deaths for frame in frames),
            flips=mean_of(frame.flips for frame in frames),
            median_life=self._lifetimes.median(),
            jitter=mean_of(frame.jitter for frame in frames),
            pop_energy=mean_of(frame.pop_energy for frame in frames),
            inverted=sum(frame.inverted for frame in frames),
        )


def _unrelated(snapshot: Snapshot, before: Snapshot) -> Snapshot:
    """A snapshot that shares no vertex: frames triangulated from scratch count from 0 each."""
    mesh = snapshot.mesh
    ids = mesh.vertex_ids + before.mesh.next_vertex_id
    apart = replace(mesh, vertex_ids=ids, next_vertex_id=int(ids.max()) + 1)
    return replace(snapshot, mesh=apart)
