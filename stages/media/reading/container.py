"""Opening a media file without trusting it."""

import io
import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import av
from av.codec.hwaccel import HWAccel
from av.container import InputContainer
from av.stream import Disposition
from av.video.stream import VideoStream

from stages.media.reading.limits import Limits
from stages.media.reading.pyav import LENIENT
from warp_kernels.errors import MediaError, OptionError

DAMAGE = (av.FFmpegError, UnicodeError, ValueError, MemoryError, OverflowError)
"""What PyAV raises on files that are damaged or not what they claim to be."""

_REFUSED_FORMATS = frozenset(
    # Scripts and playlists that name other files or addresses.
    {"concat", "dash", "hds", "hls", "imf", "rtp", "rtsp", "sap", "sdp", "webm_dash_manifest"}
    # Devices and generators.
    | {"alsa", "fbdev", "kmsgrab", "lavfi", "oss", "video4linux2,v4l2", "x11grab"}
    # Text drawn as pictures: any text file would pass for a video.
    | {"adf", "bin", "idf", "tty", "xbin"}
)
_ADDRESS = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:/")
_PICTURE_FORMATS = re.compile(r".*_pipe|image2|ico|fits|alias_pix|brender_pix")


@dataclass(frozen=True)
class ChosenVideo:
    """The video stream that is meant, and why."""

    stream: VideoStream
    """The stream; it has a decoder."""
    notes: tuple[str, ...]
    """What was passed over, one sentence each."""


def open_container(
    path: Path,
    max_pixels: int = Limits.pixels,
    rate: Fraction | None = None,
    content: bytes | None = None,
    max_streams: int = Limits.streams,
    hwaccel: HWAccel | None = None,
) -> InputContainer:
    """Open a local file for reading.

    Args:
        path: The file; network addresses, devices and playlists are refused.
        max_pixels: Largest picture that a decoder may allocate [px].
        rate: Frames per second of what has no times; None for FFmpeg's 25.
        content: What is read in place of the file's own content, or None.
        max_streams: The most that it may have.
        hwaccel: What decodes it, or None for the CPU.

    Raises:
        MediaError: If there is no such regular file, or its content is no known media format.
    """
    _check_regular(path)
    options = {
        "protocol_whitelist": "file",
        "format_whitelist": ",".join(sorted(av.formats_available - _REFUSED_FORMATS)),
        "pattern_type": "none",
        "max_pixels": str(max_pixels),
        "max_streams": str(max_streams + 1),  # one more tells that there are too many
        **({} if rate is None else {"framerate": str(rate)}),
    }
    try:
        place = f"file:{path}" if content is None else io.BytesIO(content)
        return av.open(place, "r", options=options, hwaccel=hwaccel, **LENIENT)
    except av.error.PermissionError as error:
        raise MediaError(path, "may not be read", "check its permissions") from error
    except av.error.ArgumentError as error:
        raise MediaError(
            path, "is a playlist, a script or a device", "give the media file itself"
        ) from error
    except DAMAGE as error:
        raise MediaError(
            path, f"not a readable media file ({reason_of(error)})", "check or convert the file"
        ) from error


def _check_regular(path: Path) -> None:
    try:
        size = path.stat().st_size
    except (OSError, ValueError) as error:
        if _ADDRESS.match(str(path)):
            remedy = "download the file and give its name"
            written = re.sub(":/+", "://", str(path), count=1)  # a path has lost one of them
            raise MediaError(written, "is a network address", remedy) from error
        remedy = "check the name"
        if re.search(r"#|%\d*d", path.name):
            remedy += "; numbered stills are written name_####.png, or name_%01d.png without zeros"
        is_missing = isinstance(error, FileNotFoundError)
        why = "" if is_missing else f" ({_system_reason(error)})"
        raise MediaError(path, f"no such file{why}", remedy) from error
    if path.is_dir():
        raise MediaError(path, "is a folder", "give a file, or a pattern such as name_####.png")
    if not path.is_file():
        raise MediaError(
            path, "is not a regular file", "copy the media into a file, or pipe it in as -"
        )
    if size == 0:
        raise MediaError(path, "is empty (0 bytes)", "check how the file was made")


def choose_video(container: InputContainer, path: Path, wanted: int | None = None) -> ChosenVideo:
    """Choose the stream that a player would show; cover pictures do not count.

    Args:
        container: The opened file.
        path: The file, for messages.
        wanted: Index of the stream that the user chose, or None.

    Raises:
        OptionError: If there is no such stream.
        MediaError: If there is no video stream, or no decoder for one.
    """
    every = [stream for stream in container.streams.video if not _is_cover(stream)]
    if not every:
        cover = "only a cover picture" if container.streams.video else "no video stream"
        raise MediaError(path, f"holds {cover}", "give a video or an image")
    usable = [stream for stream in every if stream.codec_context is not None]
    if not usable:
        raise MediaError(
            path,
            f"no decoder for its video codec ({_codec_tag(container, every[0])})",
            "convert it to H.264 with another program first",
        )
    if wanted is not None:
        return ChosenVideo(_stream_of(usable, wanted, path), ())
    best = container.streams.best("video")
    chosen = next((stream for stream in usable if best and stream.index == best.index), usable[0])
    notes = []
    if len(every) > 1:
        others = ", ".join(str(stream.index) for stream in every if stream is not chosen)
        notes.append(
            f"several video streams: stream {chosen.index} is used, {others} ignored; --stream N "
            "chooses"
        )
    return ChosenVideo(chosen, tuple(notes))


def _stream_of(usable: list[VideoStream], wanted: int, path: Path) -> VideoStream:
    for stream in usable:
        if stream.index == wanted:
            return stream
    known = ", ".join(str(stream.index) for stream in usable)
    raise OptionError(f"--stream {wanted}: {path} has no such video stream; choose from {known}")


def is_picture(container: InputContainer) -> bool:
    """Whether the file is a still picture rather than a video.

    Args:
        container: The opened file.
    """
    return _PICTURE_FORMATS.fullmatch(container.format.name) is not None


def reason_of(error: Exception) -> str:
    """FFmpeg's or the system's own words, without its name of the place.

    Args:
        error: One of `DAMAGE`, or an OSError.
    """
    if isinstance(error, av.FFmpegError):
        return str(error.strerror or error).strip().rstrip(".").lower()
    if isinstance(error, MemoryError):
        return "out of memory"
    return _system_reason(error).lower()


def _system_reason(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error)


def _is_cover(stream: VideoStream) -> bool:
    return bool(stream.disposition & (Disposition.attached_pic | Disposition.timed_thumbnails))


def _codec_tag(container: InputContainer, stream: VideoStream) -> str:
    """Four letters of an unknown codec, as FFmpeg's description of the file has them."""
    level = av.logging.get_level()
    av.logging.set_level(av.logging.INFO)  # the description goes through the log
    try:
        text = container.dumps_format()  # type: ignore[attr-defined]
    finally:
        av.logging.set_level(level)
    described = re.search(rf"Stream #0:{stream.index}\b.*?Video: ([^,\n]+)", text)
    return described[1].strip() if described else "unknown"
