"""`trimotion preview`: a contact sheet of a few moments, and the time that the whole would take."""

import json
from fractions import Fraction
from pathlib import Path

from pipeline.loop.preview import Moment, Preview, preview
from pipeline.options.job import Job
from pipeline.progress import Progress
from pipeline.track import refuse_track
from stages.look.sheet import of_width, sheet_of
from stages.media import EncodeOptions, FrameRange, check_output, open_encoder, probe
from warp_kernels.errors import OptionError

ONE = FrameRange(0, 0)
"""A sheet is one picture."""
WIDTH = 480
"""Width of a moment [px]."""
LONG = 120
"""Seconds from which on they are told as minutes."""


def make_preview(job: Job, progress: Progress) -> Preview:
    """Write the sheet.

    Args:
        job: What is to be done; its output is the sheet.
        progress: Told of every moment.

    Raises:
        OptionError: If the sheet is no still.
        TrimotionError: As `animate` does.
    """
    path, encode = job.output.path, EncodeOptions(overwrite=job.output.overwrite, audio=False)
    assert path is not None
    refuse_track(job.solve.source)
    info = probe(job.solve.source, read=job.solve.read)
    plan = check_output(path, info, (WIDTH, WIDTH), encode, ONE)
    if plan.container is not None or plan.pattern is not None:
        raise OptionError(f"-o {path}: a preview is one picture; name it .png or .jpg")
    found = preview(job, progress)
    cells = of_width([moment.pixels for moment in found.moments], WIDTH)
    sheet = sheet_of(cells, [_caption(moment) for moment in found.moments], len(cells))
    size = (sheet.shape[1], sheet.shape[0])
    with open_encoder(path, info, size, encode, ONE) as out:
        out.write(sheet, 0, Fraction(1), 0)
    return found


def told(found: Preview, output: Path) -> str:
    """What is told of a preview, in one line.

    Args:
        found: The preview.
        output: The sheet.
    """
    noun = "frame" if found.frames == 1 else "frames"
    each = f", {found.later:.3g} s each" if found.later else ""
    shots = f" and {found.first:.2g} s for every further shot" if found.later else ""
    return f"{found.frames} {noun}{each}: about {_time(found.seconds)} in all{shots}; {output}"


def as_json(found: Preview, output: Path) -> str:
    """The same for programs.

    Args:
        found: The preview.
        output: The sheet.
    """
    figures = {
        "output": str(output),
        "moments": [moment.frame for moment in found.moments],
        "frames": found.frames,
        "seconds": round(found.seconds, 3),
        "seconds_first": round(found.first, 4),
        "seconds_later": round(found.later, 4),
    }
    return json.dumps(figures)


def _caption(moment: Moment) -> str:
    if moment.time is None:
        return f"frame {moment.frame}"
    return f"frame {moment.frame}, {_clock(float(moment.time))}"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(seconds, 60)
    return f"{int(minutes)}:{rest:04.1f}"


def _time(seconds: float) -> str:
    """A duration as people say it."""
    if seconds < LONG:
        return f"{seconds:.0f} s" if seconds >= 10 else f"{seconds:.1f} s"
    minutes = seconds / 60
    return f"{minutes:.0f} min" if minutes < LONG else f"{minutes / 60:.1f} h"
