"""The decoded frames of one file's video stream, as FFmpeg gives them."""

from collections.abc import Generator, Iterator
from fractions import Fraction
from pathlib import Path

from av.video.frame import VideoFrame

from stages.media.card_decoder import CARD, card_for
from stages.media.orientation import Orientation, orientation_of
from stages.media.reading.alpha_decoder import alpha_decoder
from stages.media.reading.coded_photo import CodedPhoto, open_photo
from stages.media.reading.container import (
    DAMAGE,
    ChosenVideo,
    choose_video,
    is_picture,
    open_container,
    reason_of,
)
from stages.media.reading.pages import pages_of, with_page_first
from stages.media.reading.picture_size import check_size, check_streams
from stages.media.reading.read_options import AS_IT_COMES, ReadOptions
from stages.media.reading.side_data import side_data
from warp_kernels.device.memory import refuse_if_short
from warp_kernels.errors import MediaError, OptionError

MAX_FAILURES = 10_000
"""Undecodable packets after which a file is given up."""


class VideoSource:
    """An opened file that yields its video's raw frames and survives damage.

    Use as a context manager. Frames come in the order in which they are shown; packets that
    cannot be decoded are skipped and counted, and a file that breaks off simply ends.
    """

    def __init__(
        self,
        path: Path,
        max_pixels: int | None = None,
        threads: int = 0,
        read: ReadOptions = AS_IT_COMES,
    ) -> None:
        """Open a file.

        Args:
            path: A local file.
            max_pixels: Largest picture that is decoded [px]; None for what was chosen.
            threads: Decoder threads, 0 for one per core.
            read: What the user chose.

        Raises:
            OptionError: If a page or stream is chosen that there is not.
            MediaError: If it cannot be opened, holds no video or declares too large a picture.
        """
        self.path = path
        self.failures = 0
        """Number of packets that could not be decoded so far."""
        self.reason = ""
        """Why the first of them could not."""
        max_pixels = read.most.pixels if max_pixels is None else max_pixels
        self._max_pixels = max_pixels
        self._guard = max_pixels + max_pixels // 8 + 2**16  # decoders round sizes up
        self._threads = threads
        self._read = read
        self._photo: CodedPhoto | None = None
        self._open()

    def _open(self) -> None:
        read = self._read
        most = read.most.streams
        self.container = open_container(self.path, self._guard, read.fps, max_streams=most)
        try:
            check_streams(self.path, len(self.container.streams), most)
            pages = self._choose_page()
            self._photo = open_photo(self.path, self.container, self._max_pixels, read.page)
            chosen = self._photo or choose_video(self.container, self.path, read.stream)
            told = (*chosen.notes, *pages)
            if read.decoder == CARD and not self.is_picture:
                chosen, told = self._on_card(chosen, told)
            self.stream, self.notes = chosen.stream, told
            codec = self.stream.codec_context
            check_size(self.path, codec.width, codec.height, self._max_pixels)
            codec.options = {"max_pixels": str(self._guard)}
            self.stream.thread_type = "AUTO"
            self.stream.thread_count = self._threads
            self._alpha_decoder = alpha_decoder(self.stream, self._guard, self._threads)
        except BaseException:
            self.container.close()
            raise
        self._ahead: VideoFrame | None = None
        self._decoded = self._photo.frames() if self._photo else self._decode_all()

    def _on_card(
        self, chosen: ChosenVideo | CodedPhoto, told: tuple[str, ...]
    ) -> tuple[ChosenVideo | CodedPhoto, tuple[str, ...]]:
        """Open the file again for a card to decode, if there is one that can."""
        read, (card, reason) = self._read, card_for(chosen.stream)
        if card is None:
            return chosen, (*told, f"--decoder {CARD}: the CPU decodes: {reason}")
        self.container.close()
        most = read.most.streams
        self.container = open_container(
            self.path, self._guard, read.fps, max_streams=most, hwaccel=card
        )
        return choose_video(self.container, self.path, read.stream), told

    def _choose_page(self) -> tuple[str, ...]:
        """Open the page of a TIFF that is wanted, and note that there are others."""
        page = self._read.page
        if "tiff" not in self._codec_names():
            if page is not None and page > 1 and "mp4" not in self.container.format.name:
                raise OptionError(f"--page {page}: {self.path} has one picture; leave it out")
            return ()
        pages = pages_of(self.path)
        if page is not None and page > max(1, len(pages)):
            what = f"{len(pages)} pages" if len(pages) > 1 else "one page"
            raise OptionError(f"--page {page}: {self.path} has {what}; give a smaller number")
        if len(pages) < 2:
            return ()
        if page is not None:
            self.container.close()
            content = with_page_first(self.path, pages[page - 1])
            self.container = open_container(self.path, self._guard, content=content)
        shown = "the first is" if page is None else f"page {page} is"
        return (f"{len(pages)} pages in one file: {shown} shown, --page N shows another",)

    def _codec_names(self) -> set[str]:
        streams = self.container.streams.video
        return {s.codec_context.name for s in streams if s.codec_context and self.is_picture}

    def reopen(self) -> None:
        """Start again at the first frame."""
        self.close()
        self._open()

    @property
    def is_picture(self) -> bool:
        """Whether the file is a still picture."""
        return self._photo is not None or is_picture(self.container)

    @property
    def format_name(self) -> str:
        """FFmpeg's name of the file format, or `heif`."""
        return "heif" if self._photo else str(self.container.format.name)

    def orientation_of(self, frame: VideoFrame) -> Orientation:
        """How a frame of this file is to be shown.

        Args:
            frame: A decoded frame.
        """
        return self._photo.orientation if self._photo else orientation_of(frame)

    def profile_of(self, frame: VideoFrame) -> bytes | None:
        """ICC profile of a frame of this file, or None.

        Args:
            frame: A decoded frame.
        """
        return self._photo.photo.profile if self._photo else side_data(frame, "ICC_PROFILE")

    @property
    def time_base(self) -> Fraction:
        """Seconds per unit of pts."""
        base = self.stream.time_base
        return Fraction(base) if base else Fraction(1, 90000)

    @property
    def declared_frames(self) -> int:
        """Number of frames that the file states, without those that its edit list hides; 0 if none.

        Clips that were trimmed without encoding them anew keep the frames around the cut, which
        decoders need and players do not show.
        """
        stated = int(self.stream.frames)
        entries = self.stream.index_entries
        if stated and "mp4" in self.format_name and len(entries):
            return sum(not entry.is_discard for entry in entries)
        return stated

    @property
    def average_rate(self) -> Fraction | None:
        """Frames per second as declared or guessed by FFmpeg; None if unknown.

        More than one frame per unit of the clock is a mistake in the file; encoders refuse it.
        """
        for rate in (self.stream.average_rate, self.stream.guessed_rate):
            if rate and rate * self.time_base <= 1:
                return Fraction(rate)
        return None

    def first_frame(self) -> VideoFrame:
        """The first frame that can be decoded; it is still yielded by `frames`.

        Raises:
            MediaError: If there is none, or a picture is too large.
        """
        if self._ahead is None:
            self._ahead = next(self._decoded, None)
        if self._ahead is None:
            raise self._undecodable()
        return self._ahead

    def _undecodable(self) -> MediaError:
        codec = self.stream.codec_context.name
        if self.is_picture:
            # Under a limit FFmpeg does not even report the size of a picture beyond it.
            with open_container(self.path, max_pixels=2**31 - 1) as container:
                header = choose_video(container, self.path).stream.codec_context
                check_size(self.path, header.width, header.height, self._max_pixels)
        reason = f" ({self.reason})" if self.reason else ""
        if self.stream.codec_context.width == 0:
            reason = " (damaged, or larger than 268 million pixels)"
        remedy = "check or convert the file"
        if codec == "webp":
            remedy = "animated WebP cannot be read: convert it to GIF, PNG stills or a video"
        return MediaError(self.path, f"no frame of its {codec} can be decoded{reason}", remedy)

    def frames(self) -> Iterator[VideoFrame]:
        """The frames that were not yielded yet, to the end or to where the file breaks off."""
        if self._ahead is not None:
            ahead, self._ahead = self._ahead, None
            yield ahead
        yield from self._decoded

    def seek(self, pts: int) -> None:
        """Go on at the last key frame at or before a time.

        Args:
            pts: The time [time base units].

        Raises:
            av.FFmpegError: If the container cannot seek.
        """
        self.container.seek(pts, stream=self.stream, backward=True)
        if self._alpha_decoder is not None:
            self._alpha_decoder.flush_buffers()
        self._ahead = None
        self._decoded = self._decode_all()

    def close(self) -> None:
        """Release the file."""
        self._decoded.close()
        self.container.close()

    def __enter__(self) -> "VideoSource":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _decode_all(self) -> Generator[VideoFrame, None, None]:
        packets = self.container.demux(self.stream)
        while True:
            try:
                packet = next(packets, None)
                if packet is None:
                    return
                frames = (self._alpha_decoder or self.stream).decode(packet)
            except EOFError:
                return
            except DAMAGE as error:
                refuse_if_short(error)
                self._count(error)
                if self.failures > MAX_FAILURES:
                    return
                continue
            yield from frames

    def _count(self, error: Exception) -> None:
        self.failures += 1
        self.reason = self.reason or reason_of(error)
