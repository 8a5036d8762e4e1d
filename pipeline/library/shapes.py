"""Write the triangles of one frame as shapes and numbers."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from pipeline.library.draw import suited
from pipeline.library.pixels import info_of
from pipeline.look.exporting import check_exporting
from pipeline.options.build import fill, values_of
from pipeline.options.job import Job
from stages.exchange import FORMATS, is_exchange
from stages.exchange.figure import Figure
from stages.exchange.writer import ShapeWriter
from stages.frame import Frame
from stages.look.paint import paint_of
from stages.media.naming import NumberedPattern
from stages.snapshot import Snapshot
from stages.toning.choices import Choices
from stages.toning.tone import toned
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError


def written(
    snapshot: Snapshot,
    frame: Frame | None,
    shot: int,
    model: ColorModel,
    path: Path,
    given: Mapping[str, Any],
) -> list[str]:
    """Write a snapshot.

    Args:
        snapshot: The triangles and their colours.
        frame: The picture, or None if it was not kept.
        shot: Number of the frame with which its shot begins.
        model: The colour model that was optimised.
        path: The file; its ending says how it is written.
        given: Options of the look, the output and the run, by field name.

    Returns:
        Choices that were made, one sentence each.

    Raises:
        OptionError: If a value is impossible, or the format cannot hold the look.
        OutputError: If the file cannot be written.
    """
    if not is_exchange(path) or NumberedPattern.parse(path):
        endings = " ".join(FORMATS)
        raise OptionError(f"{path}: one file of shapes is written, {endings}; draw makes pixels")
    source = Path("triangulation")
    named = {**given, "color": model.name, "source": str(source), "output": str(path)}
    job = fill(Job, values_of(named))
    size = (snapshot.mesh.width, snapshot.mesh.height)
    info = replace(info_of(size, "image", source), frame_count=1)
    plan, film = check_exporting(job, info)
    snapshot = suited(snapshot, frame, job.look, model, job.run)
    paint = toned(paint_of(snapshot), job.look.tone, Choices.none())
    writer = ShapeWriter(plan, film)
    writer.write(Figure(snapshot, shot, Fraction(0), paint))
    writer.close()
    return writer.notes
