"""Draw the triangles of one frame by themselves."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from pipeline.library.device import opened_device
from pipeline.options.build import fill, values_of
from pipeline.options.look import Look
from pipeline.options.run import Run
from stages.frame import Frame
from stages.look.framing import framed
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError


def drawn(
    snapshot: Snapshot, frame: Frame | None, model: ColorModel, given: Mapping[str, Any]
) -> np.ndarray:
    """Draw a snapshot.

    Args:
        snapshot: The triangles and their colours.
        frame: The picture, or None if it was not kept.
        model: The colour model that was optimised.
        given: Options of the look and the run, by field name.

    Returns:
        Code values, [rows, columns, 3] or [rows, columns, 4] uint8.

    Raises:
        OptionError: If a value is impossible, or the picture is needed and not there.
    """
    values = values_of(given)
    look, run = fill(Look, values), fill(Run, values)
    styles, fitted = look.shown_styles(model), look.fitted(model)
    size = (snapshot.mesh.width, snapshot.mesh.height)
    framing = look.framing_for(size, Fraction(1))
    is_short = fitted.degree > snapshot.model.degree
    if frame is None and (is_short or look.needs_source):
        names = ", ".join(type(style).__name__.lower() for style in styles)
        raise OptionError(
            f"styles: {names} need the picture, and a track holds none; draw the track by render"
        )
    with opened_device(run.device, run.threads) as device:
        if frame is not None and fitted != snapshot.model:
            options = TriangulateOptions(color=model.name)
            snapshot = Triangulator(device, size, options, fitted).fit(frame, snapshot.mesh)
        renderer = Renderer(device, size, framing.picture, styles)
        source = None if frame is None else frame.pixels
        pixels = renderer.render(snapshot, source=source, tone=look.tone)
    return framed(pixels, framing, look.backdrop(model))
