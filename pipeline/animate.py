"""Video in, triangulated video out: the only loop over time."""

from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from pipeline.job import Job
from pipeline.progress import Progress
from pipeline.shots import ShotFrame, with_shots
from pipeline.stream import Behind, ahead
from stages.advect import advect
from stages.flows import FlowField
from stages.frame import Frame
from stages.media import check_output, open_decoder, open_encoder
from stages.media.encode import Encoder
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from stages.weights import open_weights
from warp_kernels.color_model import CONSTANT, LINEAR
from warp_kernels.device import Device
from warp_kernels.errors import MediaError
from warp_kernels.styles import Flat, Gradient, Style

DECODED_AHEAD = 3
"""Decoded frames that may wait."""
SOLVED_BEHIND = 3
"""Triangulated frames that may wait to be drawn and encoded."""


@dataclass(frozen=True)
class Animated:
    """What a finished job came to."""

    frames: int
    """Frames written."""
    seconds: float
    """Wall time, from the first frame's decoding to the finished file [s]."""
    mean_rmse: float
    """Mean over the frames of the root mean square error [code values]."""
    warnings: tuple[str, ...]
    """Damage that was met, one sentence each."""
    notes: tuple[str, ...]
    """Choices that were made, one sentence each."""


@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """A frame and the motion that led to it."""

    frame: Frame
    """The frame."""
    motion: FlowField | None
    """Motion from the frame before, or None where a mesh starts anew."""


def animate(job: Job, progress: Progress) -> Animated:
    """Convert a source.

    Nothing is written under the output's name unless the whole job succeeds.

    Args:
        job: What to do.
        progress: Told of every finished frame.

    Raises:
        MediaError: If the source or the map of weights cannot be read.
        OptionError: If an option does not fit the source.
        OutputError: If the output cannot be written.
    """
    begun = perf_counter()
    errors: list[float] = []
    with open_decoder(job.source, job.frame_range) as decoder:
        info = decoder.info
        picture = (info.width, info.height)
        output = job.size_for(picture)
        check_output(job.output, info, output, job.encode, job.frame_range)
        weights = open_weights(job.weights, picture, job.frame_range)
        device = Device(job.device, job.threads)
        styles = job.styles or (_plain_style(job),)
        triangulator = _triangulator(job, device, picture, styles)
        renderer = Renderer(device, picture, output, styles)
        encoder = open_encoder(job.output, info, output, job.encode, job.frame_range)
        total = _expected(job, info.frame_count)
        shot_frames = with_shots(weights.beside(decoder), job.cuts)
        steps = ahead(_with_motion(shot_frames, job), DECODED_AHEAD)
        with encoder, closing(steps), Behind(_Writer(renderer, encoder), SOLVED_BEHIND) as writer:
            for snapshot in _solve(steps, triangulator, job):
                writer.put(snapshot)
                errors.append(snapshot.rmse)
                progress.frame(len(errors), total, snapshot.mesh.triangle_count, snapshot.rmse)
            if not errors:
                raise MediaError(job.source, f"no frame in {job.frame_range}", "check --frames")
    return Animated(
        frames=len(errors),
        seconds=perf_counter() - begun,
        mean_rmse=float(np.mean(errors)),
        warnings=(*decoder.warnings, *weights.warnings),
        notes=(*decoder.notes, *weights.notes, *encoder.notes),
    )


def _triangulator(
    job: Job, device: Device, size: tuple[int, int], styles: tuple[Style, ...]
) -> Triangulator:
    """What makes snapshots for the styles that will be drawn."""
    drawn = LINEAR if any(style.degree > 0 for style in styles) else CONSTANT
    weighted = job.weights is not None
    return Triangulator(device, size, job.triangulate, drawn, weighted=weighted)


def _with_motion(shot_frames: Iterable[ShotFrame], job: Job) -> Iterator[Step]:
    """Estimate the motion between the frames of a shot."""
    before: Frame | None = None
    for shot_frame in shot_frames:
        frame = shot_frame.frame
        motion: FlowField | None = None
        if before is not None and not shot_frame.opens_shot and not job.independent:
            motion = job.flow.estimate(before.pixels, frame.pixels)
        yield Step(frame, motion)
        before = frame


def _solve(steps: Iterable[Step], triangulator: Triangulator, job: Job) -> Iterator[Snapshot]:
    """Triangulate frame after frame, each from the mesh of the one before."""
    snapshot: Snapshot | None = None
    for step in steps:
        if snapshot is None or step.motion is None:
            rng = np.random.default_rng([job.seed, step.frame.index])
            snapshot = triangulator.first(step.frame, job.layout, rng)
        else:
            snapshot = triangulator.next(step.frame, advect(snapshot.mesh, step.motion))
        yield snapshot


def _plain_style(job: Job) -> Style:
    """The look that shows the optimised colours as they are."""
    return Gradient() if job.triangulate.model.degree > 0 else Flat()


def _expected(job: Job, frame_count: int | None) -> int | None:
    """How many frames there will be, as far as can be told beforehand."""
    wanted = job.frame_range
    if frame_count is None or wanted.start_time is not None or wanted.end_time is not None:
        return None
    last = frame_count - 1 if wanted.last is None else min(wanted.last, frame_count - 1)
    return max(0, (last - wanted.first) // wanted.step + 1)


class _Writer:
    """Draws and encodes one snapshot."""

    def __init__(self, renderer: Renderer, encoder: Encoder) -> None:
        self._renderer = renderer
        self._encoder = encoder

    def __call__(self, snapshot: Snapshot) -> None:
        pixels = self._renderer.render(snapshot)
        self._encoder.write(pixels, snapshot.pts, snapshot.time_base, snapshot.frame_index)
