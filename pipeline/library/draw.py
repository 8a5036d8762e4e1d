"""Draw the triangles of one frame by themselves."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pipeline.job import Job
from pipeline.library.device import opened_device
from pipeline.loop.animate import triangulator_of
from pipeline.options.build import build_job
from stages.frame import Frame
from stages.render import Renderer
from stages.snapshot import Snapshot
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError


def drawn(snapshot: Snapshot, frame: Frame | None, values: Mapping[str, Any]) -> np.ndarray:
    """Draw a snapshot.

    Args:
        snapshot: The triangles and their colours.
        frame: The picture, or None if it was not kept.
        values: Options of the look and the colour model, by field name.

    Returns:
        Code values, [rows, columns, 3] or [rows, columns, 4] uint8.

    Raises:
        OptionError: If a value is impossible, or the picture is needed and not there.
    """
    job = build_job({"source": "", "output": "", **values})
    size = (snapshot.mesh.width, snapshot.mesh.height)
    output = job.size_for(size)
    is_short = job.fitted.degree > snapshot.model.degree
    if frame is None and (is_short or job.needs_source):
        names = ", ".join(type(style).__name__.lower() for style in job.shown_styles)
        raise OptionError(
            f"styles: {names} need the picture, and a track holds none; draw the track by render"
        )
    with opened_device(job.device, job.threads) as device:
        if frame is not None and job.fitted != snapshot.model:
            snapshot = _fitted(snapshot, frame, job, device)
        renderer = Renderer(device, size, output, job.shown_styles)
        return renderer.render(snapshot, source=None if frame is None else frame.pixels)


def _fitted(snapshot: Snapshot, frame: Frame, job: Job, device: Device) -> Snapshot:
    """The same triangles in the colours that a look needs."""
    triangulator = triangulator_of(job, (frame.width, frame.height), device)
    return triangulator.fit(frame, snapshot.mesh)
