"""Pictures to a video, a GIF, a still or numbered stills."""

from fractions import Fraction
from pathlib import Path
from types import TracebackType

import numpy as np

from stages.media.frame_range import FrameRange
from stages.media.reading.info import MediaInfo
from stages.media.writing.encode_options import EncodeOptions
from stages.media.writing.output_plan import WHOLE, OutputPlan, check_output
from stages.media.writing.still_writer import StillWriter
from stages.media.writing.video_writer import VideoWriter
from warp_kernels.errors import OutputError


def open_encoder(
    path: str | Path,
    source: MediaInfo,
    size: tuple[int, int],
    options: EncodeOptions,
    frame_range: FrameRange = WHOLE,
) -> "Encoder":
    """Open an output for writing.

    Args:
        path: Output file, or a pattern of numbered stills; its ending chooses the format.
        source: What is converted; gives times, pixel aspect and sound.
        size: Width and height of the pictures that will be written [px].
        options: How to write.
        frame_range: The frames that are converted. For a part of the source, time starts at 0
            and the sound is cut to match.

    Raises:
        OptionError: If the ending, the codec and the options do not go together.
        OutputError: If the file exists, is the input, or its folder cannot be written.
    """
    plan = check_output(path, source, size, options, frame_range)
    if plan.container is None:
        return Encoder(plan, StillWriter(plan, options.crf), frame_range)
    return Encoder(plan, VideoWriter(plan, source, options, frame_range), frame_range)


class Encoder:
    """Takes pictures one by one; a context manager.

    Leaving the block normally puts the finished file under its name; leaving it by any exception
    removes what was written. Numbered stills that were already complete stay.
    """

    def __init__(
        self, plan: OutputPlan, writer: VideoWriter | StillWriter, frame_range: FrameRange
    ) -> None:
        """Prepare; use `open_encoder`.

        Args:
            plan: The checked output.
            writer: What writes the file.
            frame_range: The frames that are converted.
        """
        self.plan = plan
        """What is written."""
        self._writer = writer
        self._range = frame_range
        self._count = 0
        self._last_time: Fraction | None = None
        self._open = True

    @property
    def notes(self) -> list[str]:
        """Choices that were made, one sentence each; complete after `close`."""
        return [*self.plan.notes, *self._writer.notes]

    def write(
        self, pixels: np.ndarray, pts: int, time_base: Fraction, index: int | None = None
    ) -> None:
        """Add a picture.

        Args:
            pixels: Code values, [H, W, 3] uint8, or [H, W, 4] with straight alpha.
            pts: When it is shown, as the source has it [time_base]; later than the one before.
            time_base: Seconds per unit.
            index: Its frame number in the source, for the name of a numbered still; None to
                count from the start of the range.

        Raises:
            OutputError: If it cannot be written.
            ValueError: If the picture has another shape than announced, or time runs backwards.
        """
        expected = (self.plan.height, self.plan.width)
        if pixels.shape[:2] != expected or pixels.shape[2:] not in ((3,), (4,)):
            raise ValueError(f"pixels must be {expected} x 3 or 4, got {pixels.shape}")
        time = pts * time_base
        if self._last_time is not None and time <= self._last_time:
            raise ValueError(f"time must increase, got {time} s after {self._last_time} s")
        if isinstance(self._writer, StillWriter):
            counted = self._range.first + self._count * self._range.step
            self._writer.write(pixels, counted if index is None else index)
        else:
            self._writer.write(pixels, time, time_base)
        self._last_time = time
        self._count += 1

    def close(self) -> None:
        """Finish the output and put it under its name.

        Raises:
            OutputError: If no picture was written, or the file cannot be.
        """
        if not self._open:
            return
        self._open = False
        if self._count == 0:
            self._writer.abort()
            raise OutputError(self.plan.path, "no frame was written", "check the frame range")
        try:
            self._writer.close()
        except BaseException:
            self._writer.abort()
            raise

    def abort(self) -> None:
        """Remove what was written of an unfinished file."""
        if self._open:
            self._open = False
            self._writer.abort()

    def __enter__(self) -> "Encoder":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self.close()
        else:
            self.abort()
