"""Tracks name their source as the user does: a temporary file in its place is gone by then."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pipeline.commands.pipes import source_name
from pipeline.options.job import Job
from pipeline.track import TrackReader
from pipeline.track.relocate import relocate
from warp_kernels.errors import TrimotionError


@contextmanager
def as_called(arguments: argparse.Namespace, job: Job) -> Iterator[None]:
    """Let the track that the block solves, finished or not, name an address or a pipe.

    Args:
        arguments: What the user gave, as `pipes.piped` changed it.
        job: What is done.

    Raises:
        OutputError: If the track takes no more.
    """
    source, track = job.solve.source, job.output.track
    called = source_name(arguments, source)
    if track is None or called == str(source):
        yield
        return
    try:
        yield
    except BaseException:
        with suppress(TrimotionError):  # what broke the block off is told, and that alone
            if _is_of(track, source):
                relocate(track, called)
        raise
    relocate(track, called)


def _is_of(track: Path, source: Path) -> bool:
    """Whether a track is one that was begun from this file, and no other one in its place."""
    if not track.is_file():
        return False
    with TrackReader(track) as reader:
        return reader.header.source.path == str(source.absolute())
