"""The file that is meant where a user names a folder."""

import os
from pathlib import Path

STILLS = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"})
"""Endings of stills that are kept."""
FILMS = frozenset({".mp4", ".m4v", ".mov", ".mkv", ".webm", ".gif"})
"""Endings of films that are kept."""
OTHER_STILLS = frozenset(
    {".avif", ".bmp", ".exr", ".heic", ".heif", ".jp2", ".jxl", ".pbm", ".pgm", ".pnm", ".ppm"}
    | {".psd", ".qoi", ".tga"}
)
"""Endings of stills that can be read only; they become PNG, and any other source becomes MP4."""


def output_in(output: str | Path, source: str | Path, ending: str | None = None) -> Path:
    """The output itself, or a file in it that is named like the source if it is a folder.

    Args:
        output: What the user wrote.
        source: What is converted.
        ending: Ending of the file; None for the source's own, where that can be written.
    """
    text = os.fspath(output)
    place = Path(text)
    if not (place.is_dir() or text.endswith(("/", os.sep))):
        return place
    name = Path(source)
    own = name.suffix.lower()
    if ending is None and own in STILLS | FILMS:
        return place / name.name
    return place / f"{name.stem}{ending or ('.png' if own in OTHER_STILLS else '.mp4')}"
