"""A video or GIF file, written frame by frame."""

import contextlib
import math
from collections.abc import Iterator
from fractions import Fraction

import av
import numpy as np
from av.container import OutputContainer
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from stages.media.color.yuv import YuvWriter, over_paper
from stages.media.frame_range import FrameRange
from stages.media.reading.container import DAMAGE
from stages.media.reading.info import MediaInfo
from stages.media.sound.audio import AudioTrack, open_audio
from stages.media.sound.song import SongTrack
from stages.media.writing.commit import PendingFile, output_error
from stages.media.writing.encode_options import EncodeOptions
from stages.media.writing.encoder_setup import open_quietly, set_up, settings_of
from stages.media.writing.output_plan import OutputPlan
from stages.media.writing.pacing import Pacing, Shown
from stages.media.writing.palette import PaletteFilter
from warp_kernels.errors import OutputError

_FAILURES = (*DAMAGE, OSError)
_COARSE = {"gif": Fraction(1, 100), "matroska": Fraction(1, 1000), "webm": Fraction(1, 1000)}
"""Formats with a clock of their own; mp4 and mov take any."""
_LONGEST = {"gif": 2**16 - 1, "mp4": 2**31 - 1, "mov": 2**31 - 1}
"""Longest time for which a picture can be shown [units of the file's clock]."""
_SHORTEST = {"gif": 2}
"""Shortest time for which a picture is shown [units of the file's clock], else 1: players take a
hundredth of a second in a GIF for a mistake, and show the picture for a tenth."""


class VideoWriter:
    """Encodes pictures and carries the sound over."""

    def __init__(
        self, plan: OutputPlan, source: MediaInfo, options: EncodeOptions, frame_range: FrameRange
    ) -> None:
        """Prepare; nothing is created before the first picture.

        Args:
            plan: The checked output.
            source: What is converted.
            options: How to write.
            frame_range: The frames that are converted; a part of the source starts at time 0.
        """
        self.notes: list[str] = []
        """Choices that were made, one sentence each."""
        self._plan = plan
        self._source = source
        self._options = options
        self._shifted = not frame_range.is_whole
        self._pending = PendingFile(plan.path)
        assert plan.container is not None
        self._pacing = Pacing(_SHORTEST.get(plan.container.format, 1))
        self._output: OutputContainer | None = None
        self._audio: AudioTrack | None = None
        self._song: SongTrack | None = None
        self._start = Fraction(0)
        self._durations: dict[int | None, int] = {}
        self._last_time = Fraction(0)
        self._step: Fraction | None = None

    def write(self, pixels: np.ndarray, time: Fraction, time_base: Fraction) -> None:
        """Add a picture.

        Args:
            pixels: Code values, [H, W, 3] or [H, W, 4] uint8.
            time: When it is shown [s of the source]; later than the one before.
            time_base: The unit of the source's times [s].

        Raises:
            OutputError: If it cannot be written.
        """
        try:
            if self._output is None:
                self._open(pixels, time, time_base)
            frame = self._colors.write(self._fit(pixels))
            frame.time_base = self._clock
            if self._pacing.held is not None:
                self._step = time - self._last_time
            self._last_time = time
            self._encode(self._pacing.add(Shown(frame, time, self._ticks(time))))
        except _FAILURES as error:
            raise output_error(self._plan.path, error) from error

    def close(self) -> None:
        """Finish the file and move it to its name.

        Raises:
            OutputError: If it cannot be written.
        """
        try:
            if self._output is None:
                return
            end = self._last_time + self._last_step()
            self._encode(self._pacing.finish(self._ticks(end)))
            self._mux(self._palette.finish() if self._palette else iter(()))
            self._mux(iter((None,)))
            if self._audio is not None:
                self._audio.finish(end if self._shifted else None)
                if self._audio.problem:
                    self.notes.append(self._audio.problem)
            if self._song is not None:
                self._song.finish(end - self._start)
                if self._song.problem:
                    self.notes.append(self._song.problem)
            self._output.close()
            self._tell_dropped()
        except _FAILURES as error:
            self.abort()
            raise output_error(self._plan.path, error) from error
        finally:
            self._close_sound()
        self._pending.commit()

    def abort(self) -> None:
        """Leave nothing behind."""
        with contextlib.suppress(*_FAILURES):
            if self._output is not None:
                self._output.close()
        self._close_sound()
        self._pending.discard()

    def _close_sound(self) -> None:
        for track in (self._audio, self._song):
            if track is not None:
                track.close()

    def _open(self, pixels: np.ndarray, time: Fraction, time_base: Fraction) -> None:
        plan = self._plan
        assert plan.container is not None
        assert plan.encoder is not None
        format_name = plan.container.format
        pixel_format = self._pixel_format(pixels.shape[2])
        self._clock = _COARSE.get(format_name, Fraction(1, time_base.denominator))
        # else Matroska numbers its tracks by chance: no two runs would write the same file
        options = {**plan.container.options, "fflags": "+bitexact"}
        if format_name in ("mp4", "mov"):
            ticks = self._clock.denominator
            encoded = plan.audio is not None and self._options.song is not None
            rate = plan.audio.rate if encoded and plan.audio else self._source.audio_rate
            options["video_track_timescale"] = str(ticks)
            options["movie_timescale"] = str(_movie_clock(ticks, rate))
        self._output = av.open(
            str(self._pending.path), "w", format=format_name, container_options=options
        )
        self._stream = self._add_video(pixel_format)
        self._palette = PaletteFilter() if pixel_format == "pal8" else None
        self._colors = YuvWriter("rgb24" if self._palette else pixel_format)
        self._start = time if self._shifted else Fraction(0)
        if plan.audio is not None and self._options.song is not None:
            self._song = SongTrack(self._options.song, self._output, plan.audio)
            offset = Fraction(self._options.audio_offset)
            self._song.begin(self._source.start_time + offset - self._start)
        elif plan.audio is not None:
            self._audio = open_audio(self._source.path, self._output, plan.audio)
            if self._audio is not None:
                self._audio.begin(time if self._shifted else None)

    def _pixel_format(self, channels: int) -> str:
        encoder = self._plan.encoder
        assert encoder is not None
        if channels == 4 and encoder.alpha_format and self._options.pixel_format is None:
            return encoder.alpha_format
        return self._plan.pixel_format

    def _add_video(self, pixel_format: str) -> VideoStream:
        plan, options = self._plan, self._options
        assert self._output is not None
        assert plan.encoder is not None
        rate = self._source.average_rate or Fraction(25)
        settings = settings_of(plan.encoder, options)
        stream = self._output.add_stream(plan.encoder.name, rate=rate, options=settings)
        if not isinstance(stream, VideoStream):
            raise ValueError(f"{plan.encoder.name} is no video encoder")
        codec = stream.codec_context
        size = (plan.padded_width, plan.padded_height)
        set_up(codec, pixel_format, size, self._clock, options.threads)
        stream.time_base = self._clock
        if plan.encoder.name != "gif":
            codec.sample_aspect_ratio = stream.sample_aspect_ratio = self._aspect()
        if plan.encoder.tag and plan.container and plan.container.format in ("mp4", "mov"):
            codec.codec_tag = plan.encoder.tag
        if plan.encoder.name == "libsvtav1":
            open_quietly(codec)
        return stream

    def _aspect(self) -> Fraction:
        """Pixel aspect that keeps the shape of the source's picture."""
        source, plan = self._source, self._plan
        stretch = Fraction(source.width * plan.height, source.height * plan.width)
        if abs(stretch - 1) < Fraction(1, 50):
            return source.sample_aspect
        return (source.sample_aspect * stretch).limit_denominator(255)

    def _fit(self, pixels: np.ndarray) -> np.ndarray:
        """Repeat border pixels where the format needs even sizes; drop alpha it cannot hold."""
        if pixels.shape[2] == 4 and self._colors.drops_alpha:
            pixels = over_paper(pixels)
        down = self._plan.padded_height - pixels.shape[0]
        right = self._plan.padded_width - pixels.shape[1]
        if down or right:
            pixels = np.pad(pixels, ((0, down), (0, right), (0, 0)), mode="edge")
        return pixels

    def _last_step(self) -> Fraction:
        """How long the last picture is shown [s]."""
        source = self._source
        step = self._step or 1 / (source.average_rate or Fraction(25))
        if not self._shifted and source.duration is not None:
            declared = source.start_time + source.duration - self._last_time
            if 0 < declared < 10 * step:
                return declared
        return step

    def _ticks(self, time: Fraction) -> int:
        """A time of the source on the clock of the file."""
        return round((time - self._start) / self._clock)

    def _tell_dropped(self) -> None:
        """Say how many pictures there was no time for."""
        if self._pacing.dropped:
            assert self._plan.container is not None
            name = self._plan.container.format
            fastest = 1 / (_SHORTEST[name] * self._clock)
            self.notes.append(
                f"a {name} shows at most {fastest} pictures a second: {self._pacing.dropped} are "
                "left out evenly"
            )

    def _encode(self, settled: Iterator[tuple[Shown, int]]) -> None:
        for shown, duration in settled:
            self._encode_one(shown, duration)

    def _encode_one(self, shown: Shown, duration: int) -> None:
        assert self._plan.container is not None
        if duration > _LONGEST.get(self._plan.container.format, duration):
            raise OutputError(
                self._plan.path,
                f"a frame is shown for {float(duration * self._clock):.0f} s, longer than "
                f"{self._plan.container.format} can state",
                "write .mkv, or leave the gap out with --frames",
            )
        frame = shown.frame
        frame.pts = shown.pts
        self._durations[shown.pts] = duration
        if self._audio is not None:
            self._audio.advance(shown.time)
        if self._song is not None:
            self._song.advance(shown.time - self._start)
        self._mux(self._palette.push(frame) if self._palette else iter((frame,)))

    def _mux(self, frames: Iterator[VideoFrame | None]) -> None:
        assert self._output is not None
        for frame in frames:
            for packet in self._stream.encode(frame):
                # Encoders leave it out, and the last frame's duration is the file's end.
                packet.duration = self._durations.pop(packet.pts, 0)
                self._output.mux(packet)


def _movie_clock(ticks: int, audio_rate: int | None) -> int:
    """Ticks a second in which mp4 states where its tracks start, so that none is rounded.

    Args:
        ticks: Ticks a second of the video track.
        audio_rate: Samples a second of the sound, or None.
    """
    common = math.lcm(ticks, audio_rate or 1)
    base = common if common < 2**31 else ticks
    return base * -(-1000 // base)
