"""Draw the triangles of one frame by themselves."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from pipeline.library.device import opened_device
from pipeline.look.wardrobe import Posed, Wardrobe
from pipeline.options.build import fill, values_of
from pipeline.options.look import Look
from pipeline.options.run import Run
from stages.frame import Frame
from stages.look.framing import framed
from stages.moves.staged import check_moment
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError


def drawn(
    snapshot: Snapshot,
    frame: Frame | None,
    time: float | None,
    model: ColorModel,
    given: Mapping[str, Any],
) -> np.ndarray:
    """Draw a snapshot.

    Args:
        snapshot: The triangles and their colours.
        frame: The picture, or None if it was not kept.
        time: When it is shown [s from the first frame of its source], or None.
        model: The colour model that was optimised.
        given: Options of the look and the run, by field name.

    Returns:
        Code values, [rows, columns, 3] or [rows, columns, 4] uint8.

    Raises:
        OptionError: If a value is impossible, or the picture is needed and not there.
    """
    values = values_of(given)
    look, run = fill(Look, values), fill(Run, values)
    size = (snapshot.mesh.width, snapshot.mesh.height)
    framing = look.framing_for(size, Fraction(1))
    if time is None:
        check_moment(look.moves)
    snapshot = suited(snapshot, frame, look, model, run)
    with opened_device(run.device, run.threads) as device:
        wardrobe = Wardrobe(device, size, framing.picture, look, model)
        source = None if frame is None else frame.pixels
        view = Posed(snapshot, None, source, {}, None, None, {}, time or 0.0)
        pixels = wardrobe.draw(look, view)
    return framed(pixels, framing, look.backdrop(model))


def suited(
    snapshot: Snapshot, frame: Frame | None, look: Look, model: ColorModel, run: Run
) -> Snapshot:
    """A snapshot in the colours that a look shows.

    Args:
        snapshot: The triangles and their colours.
        frame: The picture, or None if it was not kept.
        look: The look.
        model: The colour model that was optimised.
        run: Where kernels run.

    Raises:
        OptionError: If the picture is needed and not there.
    """
    fitted = look.fitted(model)
    is_short = fitted.degree > snapshot.model.degree
    if frame is None and (is_short or look.needs_source):
        names = ", ".join(type(style).__name__.lower() for style in look.shown_styles(model))
        raise OptionError(
            f"styles: {names} need the picture, and a track holds none; draw the track by render"
        )
    if frame is None or fitted == snapshot.model:
        return snapshot
    size, options = frame.pixels.shape[1::-1], TriangulateOptions(color=model.name)
    with opened_device(run.device, run.threads) as device:
        triangulator = Triangulator(device, (size[0], size[1]), options, fitted)
        return triangulator.fit(frame, snapshot.mesh)
