"""The file that is meant where a user names a folder."""

import os
from pathlib import Path

from warp_kernels.errors import TrimotionError

STILLS = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"})
"""Endings of stills that are kept."""
FILMS = frozenset({".mp4", ".m4v", ".mov", ".mkv", ".webm", ".gif"})
"""Endings of films that are kept."""
OTHER_STILLS = frozenset(
    {".avif", ".bmp", ".exr", ".heic", ".heif", ".jp2", ".jxl", ".pbm", ".pgm", ".pnm", ".ppm"}
    | {".psd", ".qoi", ".tga"}
)
"""Endings of stills that can be read only; they become PNG."""
OTHER_FILMS = frozenset(
    {".3gp", ".apng", ".asf", ".avi", ".dv", ".f4v", ".flv", ".h264", ".hevc", ".ivf", ".m2ts"}
    | {".mjpeg", ".mpeg", ".mpg", ".mts", ".mxf", ".ogv", ".ts", ".vob", ".wmv", ".y4m"}
)
"""Endings of films that can be read only; they become MP4."""


def output_in(output: str | Path, source: str | Path, ending: str | None = None) -> Path:
    """The output itself, or a file in it that is named like the source if it is a folder.

    Args:
        output: What the user wrote.
        source: What is converted.
        ending: Ending of the file; None for the source's own, where that can be written.
    """
    text = os.fspath(output)
    place = Path(text)
    if not (os.path.isdir(place) or text.endswith(("/", os.sep))):
        return place
    name = Path(source)
    own = name.suffix.lower()
    if ending is None and own in STILLS | FILMS:
        return place / name.name
    if ending is None:
        is_one = own in OTHER_STILLS or (own not in OTHER_FILMS and is_still(name))
        ending = ".png" if is_one else ".mp4"
    return place / f"{name.stem}{ending}"


def is_still(source: Path) -> bool:
    """Whether a source is a still; it is looked into.

    Args:
        source: A file; what cannot be read is none.
    """
    if not os.path.isfile(source):
        return False
    from stages.media import probe

    try:
        return probe(source).kind == "image"
    except TrimotionError:
        return False  # whoever opens it says what is wrong
