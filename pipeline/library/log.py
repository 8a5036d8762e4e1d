"""What calls tell `logging`: the logger `trimotion`, silent until a program listens."""

import logging
from pathlib import Path

from pipeline.library.result import Result

LOG = logging.getLogger("trimotion")
"""Takes choices and summaries as INFO, damage as WARNING, finished frames as DEBUG."""
LOG.addHandler(logging.NullHandler())


def log_frame(done: int, total: int | None, rmse: float) -> None:
    """Log a finished frame.

    Args:
        done: Frames finished so far.
        total: Frames in all, if that is known.
        rmse: Its error [code values].
    """
    LOG.debug("frame %d of %s, rmse %.2f", done, "?" if total is None else total, rmse)


def log_result(source: Path, result: Result) -> None:
    """Log what came of a run.

    Args:
        source: What it was made of.
        result: What came of it.
    """
    for note in result.notes:
        LOG.info("%s: %s", source, note)
    for warning in result.warnings:
        LOG.warning("%s: %s", source, warning)
    LOG.info(
        "%s: %d frames in %.1f s, mean rmse %.2f: %s",
        source,
        result.frames,
        result.seconds,
        result.mean_rmse,
        result.output,
    )
