"""The photo of a HEIF file, decoded picture by picture and put together."""

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from pathlib import Path

from av.container import InputContainer
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from stages.media.heif import Photo, compose, read_photo
from stages.media.orientation import Orientation
from stages.media.reading.container import DAMAGE, reason_of
from stages.media.reading.picture_size import check_size
from warp_kernels.errors import MediaError, OptionError

_REMEDY = "convert it to JPEG or PNG with another program first"


@dataclass(frozen=True, eq=False)
class CodedPhoto:
    """A photo and the coded pictures that make it."""

    path: Path
    """The file."""
    container: InputContainer
    """The opened file."""
    photo: Photo
    """How the photo is made."""
    streams: Mapping[int, VideoStream]
    """FFmpeg's streams of the pictures, by the pictures' numbers."""
    page: int | None = None
    """Which picture of several was asked for, from 1."""

    @property
    def stream(self) -> VideoStream:
        """The stream of its first picture."""
        return self.streams[self.photo.tiles[0]]

    @property
    def notes(self) -> tuple[str, ...]:
        """Choices that were made, one sentence each."""
        others, page = self.photo.others, self.page
        if not others:
            return ()
        shown = "the main one is" if page is None else f"number {page} is"
        return (f"{others + 1} pictures in one file: {shown} shown, --page N shows another",)

    @property
    def orientation(self) -> Orientation:
        """How the photo is to be shown."""
        return self.photo.orientation

    def frames(self) -> Generator[VideoFrame, None, None]:
        """The photo, cropped but not turned.

        Raises:
            MediaError: If any part of it cannot be decoded.
        """
        by_index = {stream.index: number for number, stream in self.streams.items()}
        pictures: dict[int, VideoFrame] = {}
        try:
            for packet in self.container.demux(list(self.streams.values())):
                for frame in packet.decode():
                    if isinstance(frame, VideoFrame):
                        pictures.setdefault(by_index[packet.stream.index], frame)
            whole = compose(self.photo, pictures)
        except DAMAGE as error:
            raise MediaError(
                self.path, f"its photo cannot be decoded ({reason_of(error)})", _REMEDY
            ) from error
        yield whole


def open_photo(
    path: Path, container: InputContainer, max_pixels: int, page: int | None
) -> CodedPhoto | None:
    """Find the photo of an opened file.

    Args:
        path: The file.
        container: The same, opened.
        max_pixels: Largest picture that is opened [px].
        page: Which picture of several, from 1; None for the main one.

    Returns:
        The photo, or None if the file holds something else.

    Raises:
        OptionError: If there is no such picture.
        MediaError: If the photo is damaged, too large or made in a way that is not known.
    """
    if "mp4" not in container.format.name:
        return None
    try:
        photo = read_photo(path, page)
    except (ValueError, OSError) as error:
        reason = f"its photo cannot be read ({reason_of(error)})"
        raise MediaError(path, reason, _REMEDY) from error
    if photo is None:
        if page not in (None, 1):
            raise OptionError(f"--page {page}: {path} is no photo; leave the option out")
        return None
    check_size(path, *photo.size, max_pixels)
    wanted = {*photo.tiles, *(photo.mask.tiles if photo.mask else ())}
    streams = {s.id: s for s in container.streams.video if s.id in wanted and s.codec_context}
    if set(streams) != wanted:
        missing = f"FFmpeg hands over {len(streams)} of {len(wanted)} parts of its photo"
        raise MediaError(path, missing, _REMEDY)
    return CodedPhoto(path, container, photo, streams, page)
