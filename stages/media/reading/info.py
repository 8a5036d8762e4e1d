"""What is known about a source before its frames are used."""

from dataclasses import dataclass, fields
from fractions import Fraction
from pathlib import Path

from stages.media.orientation import Orientation


@dataclass(frozen=True)
class MediaInfo:
    """Properties of a source, after its first frame was decoded."""

    path: Path
    """The file, or the pattern of the stills, as the user wrote it."""
    kind: str
    """`video`, `image` or `sequence`."""
    container: str
    """FFmpeg's name of the file format."""
    codec: str
    """FFmpeg's name of the video codec."""
    pixel_format: str
    """FFmpeg's name of the stored pixel format."""
    width: int
    """Width of the upright picture [px]."""
    height: int
    """Height of the upright picture [px]."""
    coded_width: int
    """Width as stored, before rotation [px]."""
    coded_height: int
    """Height as stored, before rotation [px]."""
    rotation: int
    """Counter-clockwise turn by which the stored picture is shown [degrees: 0, 90, 180, 270]."""
    sample_aspect: Fraction
    """Width of a pixel of the upright picture over its height."""
    time_base: Fraction
    """Seconds per unit of the frames' pts."""
    average_rate: Fraction | None
    """Average frames per second; None if unknown."""
    frame_count: int | None
    """Number of frames as the file declares or implies it; an estimate. None if unknown."""
    start_time: Fraction
    """Time of the first frame [s]."""
    duration: Fraction | None
    """Length of the video [s]; None if unknown or a single picture."""
    color_matrix: str
    """Matrix by which the pixels are turned into RGB: `bt709`, `bt601`, `rgb`, ..."""
    color_range: str
    """`full` or `limited`."""
    hdr: str | None
    """`pq`, `hlg` or None."""
    audio_codec: str | None
    """FFmpeg's name of the codec of the audio stream that is carried over, or None."""
    audio_channels: int | None
    """Number of its channels, or None."""
    audio_rate: int | None
    """Its samples per second, or None."""
    notes: tuple[str, ...] = ()
    """Choices that were made in reading the file, one sentence each."""
    mirrored: bool = False
    """Whether left and right are exchanged after the turn."""

    first_frame: int = 0
    """Number of the first frame: that of numbered stills stands in their names."""

    @property
    def last_frame(self) -> int | None:
        """Number of the last frame if none is missing, an estimate; None if unknown."""
        return None if self.frame_count is None else self.first_frame + self.frame_count - 1

    @property
    def orientation(self) -> Orientation:
        """How the stored picture is shown."""
        return Orientation(self.rotation, self.mirrored)

    def as_dict(self) -> dict[str, object]:
        """The same as plain values for JSON; fractions become strings such as `1/12800`."""
        return {field.name: _plain(getattr(self, field.name)) for field in fields(self)}


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return str(value) if isinstance(value, Fraction | Path) else value
