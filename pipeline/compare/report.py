"""How close an output is to its source and how coherent, for people and for programs."""

import dataclasses
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.compare.coherence import LAGS, Coherence, mean_coherence
from pipeline.compare.track_measures import MeshFigures, TrackFigures

SMALL = 1e3
"""Squared errors of colours in [0, 1] are shown as multiples of 1 / SMALL."""


@dataclass(frozen=True)
class FrameFigures:
    """Figures of one frame."""

    frame: int
    """Its number in the source."""
    time: Fraction
    """Its time [s from the first frame that was compared]."""
    squared_error: float
    """Mean over pixels and channels of the squared difference [code value^2]."""
    coherence: Coherence
    """What it has in common with earlier frames."""
    mesh: MeshFigures | None
    """How its mesh differs from the one before, or None without a track."""

    @property
    def rmse(self) -> float:
        """Root mean square over pixels and channels [code values]."""
        return math.sqrt(self.squared_error)

    @property
    def psnr(self) -> float:
        """Peak signal to noise ratio [dB]; infinite where nothing differs."""
        return psnr(self.squared_error)

    @property
    def residual(self) -> float:
        """R of the paper: sqrt(sum E / |I|), E being half the squared error over all channels.

        Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Eq. 12.
        """
        return math.sqrt(1.5 * self.squared_error)

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON; an infinite ratio is null."""
        return {
            "frame": self.frame,
            "time": float(self.time),
            "rmse": self.rmse,
            "psnr": self.psnr if math.isfinite(self.psnr) else None,
            "R": self.residual,
            **self.coherence.as_dict(),
            "track": None if self.mesh is None else dataclasses.asdict(self.mesh),
        }


@dataclass(frozen=True)
class Report:
    """Figures of a clip."""

    source: Path
    """What was converted."""
    output: Path
    """What came out."""
    size: tuple[int, int]
    """Width and height at which they were compared [px]."""
    frames: tuple[FrameFigures, ...]
    """One entry for every frame."""
    track: TrackFigures | None
    """Figures of its meshes, or None without a track."""
    notes: tuple[str, ...]
    """How they were made comparable, one sentence each."""

    @cached_property
    def coherence(self) -> Coherence:
        """Means over the frames that have earlier ones to be compared with."""
        return mean_coherence([frame.coherence for frame in self.frames])

    @property
    def rmse(self) -> float:
        """Mean over the frames [code values]."""
        return float(np.mean([frame.rmse for frame in self.frames]))

    @property
    def residual(self) -> float:
        """Mean over the frames of R [code values]."""
        return float(np.mean([frame.residual for frame in self.frames]))

    @property
    def psnr(self) -> float:
        """Ratio of the clip as a whole [dB], so that one equal frame does not make it infinite."""
        return psnr(float(np.mean([frame.squared_error for frame in self.frames])))

    @property
    def worst(self) -> FrameFigures:
        """The frame with the largest error."""
        return max(self.frames, key=lambda frame: frame.squared_error)

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "source": str(self.source),
            "output": str(self.output),
            "width": self.size[0],
            "height": self.size[1],
            "frames": len(self.frames),
            "rmse": self.rmse,
            "psnr": self.psnr if math.isfinite(self.psnr) else None,
            "R": self.residual,
            **self.coherence.as_dict(),
            "track": None if self.track is None else dataclasses.asdict(self.track),
            "worst": self.worst.as_dict(),
            "notes": list(self.notes),
            "per_frame": [frame.as_dict() for frame in self.frames],
        }

    def as_json(self) -> str:
        """All figures."""
        return json.dumps(self.as_dict(), indent=2)

    def as_table(self) -> str:
        """The figures of the clip and of its worst frame."""
        worst = self.worst
        noun = "frame" if len(self.frames) == 1 else "frames"
        errors = [
            ("", "rmse", "PSNR [dB]", "R"),
            ("mean", *_figures(self.rmse, self.psnr, self.residual)),
            (f"worst (frame {worst.frame})", *_figures(worst.rmse, worst.psnr, worst.residual)),
        ]
        blocks = [
            f"{len(self.frames)} {noun} at {self.size[0]}x{self.size[1]}",
            _aligned(errors),
            *([_aligned(_coherence_rows(self.coherence))] if len(self.frames) > 1 else []),
            *([_aligned(_track_rows(self.track))] if self.track is not None else []),
        ]
        return "\n".join([*blocks, *(f"note: {note}" for note in self.notes)])


def psnr(squared_error: float) -> float:
    """Peak signal to noise ratio [dB] of a mean squared error [code value^2]."""
    return math.inf if squared_error == 0 else 10 * math.log10(255.0**2 / squared_error)


def squared_error(before: np.ndarray, after: np.ndarray) -> float:
    """Mean squared difference of two pictures, code values, [H, W, 3] each [code value^2]."""
    return float(np.mean(np.square(before.astype(np.float64) - after)))


def _coherence_rows(coherence: Coherence) -> Iterator[tuple[str, ...]]:
    yield "coherence", "output", "source"
    for lag in LAGS:
        values = coherence.warp_errors[lag], coherence.source_warp_errors[lag]
        yield f"E_warp, lag {lag} [1e-3]", *_figures(*values, scale=SMALL)
    yield "tOF [px]", *_figures(coherence.motion_difference)


def _track_rows(track: TrackFigures) -> Iterator[tuple[str, ...]]:
    yield "track", ""
    yield "births per step", *_figures(track.births)
    yield "deaths per step", *_figures(track.deaths)
    yield "flips per step", *_figures(track.flips)
    yield "pop energy per step [1e-3]", *_figures(track.pop_energy, scale=SMALL)
    yield "jitter [px]", *_figures(track.jitter)
    yield "median life of a triangle [frames]", *_figures(track.median_life)
    yield "inverted triangles in all", str(track.inverted)


def _figures(*values: float | None, scale: float = 1.0) -> Iterator[str]:
    return ("-" if value is None else f"{scale * value:.3f}" for value in values)


def _aligned(rows: Iterable[Sequence[str]]) -> str:
    """Labels to the left, figures to the right."""
    listed = [tuple(row) for row in rows]
    width = max(len(row[0]) for row in listed)
    return "\n".join(
        (f"{label:<{width}}" + "".join(f"{figure:>11}" for figure in figures)).rstrip()
        for label, *figures in listed
    )
