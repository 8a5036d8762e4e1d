"""Convert one input, or several one after the other whatever becomes of each."""

import argparse
import os
import traceback
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from pipeline.commands.batch import TRACKS, Batch, Item, batch_of
from pipeline.commands.convert import check_options, convert, progress_for
from pipeline.commands.inputs import take
from pipeline.commands.output_folder import output_folder
from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    from pipeline.loop.result import Animated


def convert_all(
    arguments: argparse.Namespace, report: Callable[[BaseException, argparse.Namespace], int]
) -> int:
    """Convert what the user named.

    Args:
        arguments: What the user gave; names of the input and output are replaced.
        report: Tells of a failure in one line and gives its exit code.

    Returns:
        The exit code of the worst.

    Raises:
        TrimotionError: If nothing was begun; or the failure of one that stands alone.
    """
    batch = batch_of(arguments.command, arguments.inputs, arguments.output)
    if batch is None:
        output = arguments.output
        folder = Path(output) if output.endswith(("/", os.sep)) else None
        with output_folder(folder), output_folder(_tracks_of(arguments) if folder else None):
            convert(arguments)
        return 0
    _check_shared(arguments)
    _aim(arguments, batch.items[0])
    check_options(arguments)
    with output_folder(batch.folder), output_folder(_tracks_of(arguments)):
        return _convert_each(batch, arguments, report)


def _convert_each(
    batch: Batch,
    arguments: argparse.Namespace,
    report: Callable[[BaseException, argparse.Namespace], int],
) -> int:
    """Convert one input after the other; gives the exit code of the worst."""
    outcome = Outcome(batch)
    with progress_for(arguments) as progress:
        for note in batch.notes:
            progress.note(note)
    for number, item in enumerate(batch.items, start=1):
        with progress_for(arguments) as progress:
            progress.file(number, len(batch.items), item.source, str(item.output))
        _aim(arguments, item)
        try:
            outcome.add(convert(arguments))
        except Exception as error:  # the others do not depend on it
            if arguments.debug:
                traceback.print_exc()
            outcome.fail(item, report(error, arguments))
    with progress_for(arguments) as progress:
        progress.finish_all(outcome.as_line(), outcome.frames, list(outcome.failed), outcome.code)
    return outcome.code


def _aim(arguments: argparse.Namespace, item: Item) -> None:
    """Name one of the inputs and its output."""
    take(arguments, item.source)
    arguments.output = str(item.output)


class Outcome:
    """What has become of a batch so far.

    Args:
        batch: What is done.
    """

    def __init__(self, batch: Batch) -> None:
        self._batch = batch
        self._begun = perf_counter()
        self.frames = 0
        """Frames of those that were done."""
        self.failed: list[str] = []
        """Inputs that failed."""
        self.code = 0
        """Exit code of the worst."""

    def add(self, result: "Animated") -> None:
        """Count one that was done."""
        self.frames += result.frames

    def fail(self, item: Item, code: int) -> None:
        """Count one that failed."""
        self.failed.append(item.source)
        self.code = max(self.code, code)

    def as_line(self) -> str:
        """The summary, for people."""
        total, seconds = len(self._batch.items), perf_counter() - self._begun
        done = f"{total - len(self.failed)} of {total} done"
        failed = f", failed: {', '.join(self.failed)}" if self.failed else ""
        told = f"{done}, {self.frames} frames in {seconds:.1f} s"
        return f"{told}: {self._batch.folder}{os.sep}{failed}"


def _tracks_of(arguments: argparse.Namespace) -> Path | None:
    """The folder that tracks go to beside the outputs, if one is named: no name of a track."""
    track = None if arguments.command == "render" else getattr(arguments, "track", None)
    if track is None or (Path(track).suffix.lower() in TRACKS and not os.path.isdir(track)):
        return None
    return Path(track)


def _check_shared(arguments: argparse.Namespace) -> None:
    """Refuse one file that all outputs would share.

    Raises:
        OptionError: If a track or a report is named for all.
    """
    track = getattr(arguments, "track", None)
    if arguments.command != "render" and track is not None and _tracks_of(arguments) is None:
        raise OptionError(f"--track {track}: several inputs: name a folder, such as tracks/")
    if "report" in arguments:
        raise OptionError(
            f"--report {arguments.report}: several inputs: a report tells of one; convert them one "
            "by one"
        )
