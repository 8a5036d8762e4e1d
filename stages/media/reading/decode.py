"""Frames of a video, a still or numbered stills: upright, full-range RGB, times increasing."""

from collections import deque
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from av.video.frame import VideoFrame

from stages.frame import Frame
from stages.media.color.hdr import tone_map
from stages.media.color.yuv import WHITE, RgbReader, read_color
from stages.media.expected_frames import expected_frames
from stages.media.frame_range import FrameRange
from stages.media.naming import NumberedPattern, input_pattern
from stages.media.orientation import upright
from stages.media.reading.container import DAMAGE, reason_of
from stages.media.reading.count import count_frames
from stages.media.reading.deinterlace import deinterlace
from stages.media.reading.frame_index import seek_to_frame
from stages.media.reading.info import MediaInfo
from stages.media.reading.probe import describe, describe_sequence
from stages.media.reading.read_options import AS_IT_COMES, ReadOptions
from stages.media.reading.sequence import existing_numbers, refuse_gaps, still_frames
from stages.media.reading.source import VideoSource
from stages.media.timing import TimeRepair, usual_step
from warp_kernels.device.memory import refuse_if_short, refuse_without_room
from warp_kernels.errors import MediaError, OptionError

WHOLE = FrameRange()
"""Every frame."""


def open_decoder(
    path: str | Path,
    frame_range: FrameRange = WHOLE,
    *,
    margin: tuple[int, int] = (0, 0),
    max_pixels: int | None = None,
    threads: int = 0,
    paper: int = WHITE,
    read: ReadOptions = AS_IT_COMES,
) -> "Decoder":
    """Open a source for reading its frames.

    Args:
        path: A video, a still, or a pattern of numbered stills such as `shot_####.png`.
        frame_range: The frames wanted. Stills of a sequence go by the number in their name.
        margin: Frames given beyond the range before and after it, in its steps, where the source
            has them.
        max_pixels: Largest picture that is opened [px]; None for what was chosen.
        threads: Decoder threads, 0 for one per core.
        paper: Grey that shows through transparent pixels [code value].
        read: What the user chose.

    Raises:
        MediaError: If it cannot be read.
        OptionError: If a choice does not fit the source, or a pattern has several number fields.
    """
    pattern = input_pattern(path)
    if pattern is not None:
        return _SequenceDecoder(pattern, frame_range, margin, max_pixels, paper, read)
    return _FileDecoder(Path(path), frame_range, margin, max_pixels, threads, paper, read)


class Decoder:
    """Iterator over the frames of a source; a context manager; holds one frame at a time."""

    info: MediaInfo
    """What the source is."""

    def __init__(
        self,
        info: MediaInfo,
        frame_range: FrameRange,
        margin: tuple[int, int],
        source_name: str,
        paper: int,
        read: ReadOptions,
    ) -> None:
        """Prepare the parts that all sources share; use `open_decoder`.

        Args:
            info: What the source is.
            frame_range: The frames wanted.
            margin: Frames given before and after the range.
            source_name: The source, for messages.
            paper: Grey that shows through transparent pixels [code value].
            read: What the user chose.

        Raises:
            MediaError: If the range has more frames than are believed.
        """
        self._most = read.most.frames
        _refuse_many(info, frame_range, source_name, read)
        self.info = info
        self.warnings: list[str] = []
        """Damage that was met, one sentence each; complete once the last frame was read."""
        self.notes: list[str] = list(info.notes)
        """Choices that were made, one sentence each."""
        self._range = frame_range
        self._before, self._after = margin
        self._name = source_name
        self._paper = paper
        self._reader = RgbReader(paper)
        self._shown = info.orientation
        self._profile: bytes | None = None
        self._delivered = 0
        self._met = False
        self._iterator: Iterator[Frame] | None = None

    def __iter__(self) -> Iterator[Frame]:
        """The frames from here on."""
        return self

    def __next__(self) -> Frame:
        if self._iterator is None:
            self._iterator = self._frames()
        frame = next(self._iterator)
        # a file need not say how many it has
        if self._delivered > self._most + self._before + self._after:
            self.close()
            rest = "the rest is left out; --limits frames=N raises that"
            self.warnings.append(f"more than {self._most} frames: {rest}")
            raise StopIteration
        return frame

    def __enter__(self) -> "Decoder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Release the source; no frame can be read afterwards."""
        self._iterator = iter(())

    def _frames(self) -> Iterator[Frame]:
        raise NotImplementedError

    def _to_frame(self, index: int, pts: int, raw: VideoFrame) -> Frame:
        info, shown = self.info, self._shown
        size = (info.height, info.width) if shown.is_sideways else (info.width, info.height)
        if (raw.width, raw.height) != size:
            self._note_once("picture size changes within the source: scaled to the first size")
        self._delivered += 1
        refuse_without_room()
        return Frame(index, pts, info.time_base, upright(self._pixels(raw, size), shown))

    def _pixels(self, raw: VideoFrame, size: tuple[int, int]) -> np.ndarray:
        color = read_color(raw, self._profile)
        try:
            if color.hdr is not None:
                pixels = tone_map(self._reader.read16(raw, color, size), color.hdr)
            else:
                pixels = self._reader.read8(raw, color, size)
        except DAMAGE as error:
            refuse_if_short(error)
            raise MediaError(
                self._name,
                f"pixels of format {raw.format.name} cannot be converted ({reason_of(error)})",
                "convert the file to H.264 first",
            ) from error
        if self._reader.saw_transparency:
            paper = {WHITE: "white", 0: "black"}.get(self._paper, f"grey {self._paper}")
            self._note_once(f"transparent parts are shown over {paper}")
        return pixels

    def _note_once(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)

    def _refuse_nothing(self, kind: str, last: int) -> None:
        """Refuse a range without a frame, and note where it reaches beyond the source.

        Args:
            kind: What the frames are called.
            last: Number of the source's last frame.
        """
        wanted, first = self._range, self.info.first_frame
        if not (self._met and self._delivered):
            available = f"{kind} {first} to {last}"
            if wanted.start_time is not None or wanted.end_time is not None:
                raise OptionError(_no_such_times(self._name, wanted, self.info, available))
            raise OptionError(
                f"frames {wanted} of {self._name}: there are none; the source has {available}"
            )
        if wanted.last is not None and wanted.last > last:
            self._note_once(f"frames {wanted}: the source ends with frame {last}")


class _FileDecoder(Decoder):
    """Frames of one video or still file."""

    def __init__(
        self,
        path: Path,
        wanted: FrameRange,
        margin: tuple[int, int],
        max_pixels: int | None,
        threads: int,
        paper: int,
        read: ReadOptions,
    ) -> None:
        self._source = VideoSource(path, max_pixels, threads, read)
        try:
            info = describe(self._source, read)
            profile = self._source.profile_of(self._source.first_frame())
            super().__init__(info, wanted, margin, str(path), paper, read)
        except BaseException:
            self._source.close()
            raise
        self._profile = profile
        self._read = read
        self._end = Fraction(0)
        self._ended = True

    def close(self) -> None:
        """Release the file; no frame can be read afterwards."""
        super().close()
        self._source.close()

    def _frames(self) -> Iterator[Frame]:
        base, wanted = self.info.time_base, self._range
        repair = TimeRepair(usual_step(self.info.average_rate, base))
        skipped = seek_to_frame(self._source, max(0, wanted.first - self._before * wanted.step))
        index, origin, past = skipped, self.info.start_time, 0
        earlier: deque[tuple[int, int, VideoFrame]] = deque(maxlen=self._before)
        for raw in deinterlace(self._source.frames()):
            pts = repair(raw.pts, raw.duration)
            if index == 0:
                origin = pts * base
            time = pts * base - origin
            past += wanted.is_past(index, time)
            if past > self._after * wanted.step:
                self._ended = False
                break
            if wanted.holds(index, time):
                self._met = True
                while earlier:
                    yield self._to_frame(*earlier.popleft())
                yield self._to_frame(index, pts, raw)
            elif past and self._met and wanted.is_in_step(index):
                yield self._to_frame(index, pts, raw)
            elif not past and wanted.is_in_step(index):
                earlier.append((index, pts, raw))
            index += 1
            self._end = pts * base
        self._report(repair.repaired, index)
        self._refuse_nothing("frames", self._last_frame(index - 1))

    def _last_frame(self, reached: int) -> int:
        """Number of the last frame, counted if the range was left without a frame of it."""
        if self._ended:
            return reached
        if self._met and self._delivered:
            return max(reached, self._range.last or 0)
        return count_frames(self._source.path, self._read) - 1

    def _report(self, repaired: int, count: int) -> None:
        if repaired:
            self._note_once(f"{repaired} frame times were missing or ran backwards: mended")
        source = self._source
        if source.failures:
            self.warnings.append(
                f"damaged: {source.failures} packets could not be decoded ({source.reason}); "
                f"{count} frames could"
            )
        if self._range.is_whole and self._breaks_off(count):
            self.warnings.append(
                f"the file breaks off or skips after {count} frames, at {float(self._end):.2f} s"
            )

    def _breaks_off(self, count: int) -> bool:
        declared, info = self._source.declared_frames, self.info
        if declared and "mp4" in info.container:
            return count < declared
        if info.kind == "image" or info.duration is None or info.average_rate is None:
            return False
        stream = self._source.stream
        if not stream.duration and "DURATION" not in stream.metadata and info.audio_codec:
            return False  # the length known may be that of the sound
        missing = info.start_time + info.duration - self._end
        return missing > max(5 / info.average_rate, info.duration / 20)


class _SequenceDecoder(Decoder):
    """Frames of numbered stills; their index is the number in the name."""

    def __init__(
        self,
        pattern: NumberedPattern,
        wanted: FrameRange,
        margin: tuple[int, int],
        max_pixels: int | None,
        paper: int,
        read: ReadOptions,
    ) -> None:
        self._pattern = pattern
        self._numbers = existing_numbers(pattern)
        self._max_pixels, self._read = max_pixels, read
        refuse_gaps(pattern, self._numbers, wanted)
        info = describe_sequence(pattern, self._numbers, max_pixels, read)
        super().__init__(info, wanted, margin, pattern.text, paper, read)

    def _frames(self) -> Iterator[Frame]:
        numbers = self._given()
        self._met = bool(numbers)
        first = self._numbers[0]
        stills = still_frames(self._pattern, numbers, self._max_pixels, self._read, self.warnings)
        for number, source, raw in stills:
            self._shown = source.orientation_of(raw)  # a camera may be turned between two
            self._profile = source.profile_of(raw)
            yield self._to_frame(number, number - first, raw)
        self._refuse_nothing("stills", self._numbers[-1])

    def _given(self) -> list[int]:
        """Numbers of the range and of its margin."""
        first, base, wanted = self._numbers[0], self.info.time_base, self._range
        in_step = [n for n in self._numbers if wanted.is_in_step(n)]
        held = [p for p, n in enumerate(in_step) if wanted.holds(n, (n - first) * base)]
        if not held:
            return []
        return in_step[max(0, held[0] - self._before) : held[-1] + 1 + self._after]


def _refuse_many(info: MediaInfo, wanted: FrameRange, name: str, read: ReadOptions) -> None:
    """Refuse a range that has more frames than are believed, if that can be told."""
    most = read.most.frames
    expected = expected_frames(wanted, info)
    if expected is None or expected <= most:
        return
    if info.kind == "video":  # files may state too many
        counted = replace(info, frame_count=count_frames(info.path, read))
        expected = expected_frames(wanted, counted)
    if expected is not None and expected > most:
        remedy = "take a part by --frames A-B, or raise --limits frames=N"
        raise MediaError(name, f"{expected} frames, more than {most}", remedy)


def _no_such_times(name: str, wanted: FrameRange, info: MediaInfo, available: str) -> str:
    """What to say if a range of times holds no frame."""
    times = (("--start", wanted.start_time), ("--end", wanted.end_time))
    told = " ".join(f"{flag} {float(time):g}" for flag, time in times if time is not None)
    if wanted.first or wanted.last is not None or wanted.step > 1:
        told = f"--frames {wanted} {told}"
    length = "" if info.duration is None else f" and lasts {float(info.duration):.2f} s"
    return f"{told}: no frame of {name} is shown then; the source has {available}{length}"
