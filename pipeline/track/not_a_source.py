"""A track in the place of a source."""

import os
from pathlib import Path

from pipeline.track.reader import is_track
from warp_kernels.errors import MediaError


def refuse_track(source: Path) -> None:
    """Say which command takes a track; FFmpeg would call it damaged.

    Args:
        source: What a user wants to convert.

    Raises:
        MediaError: If it is a mesh track.
    """
    if os.path.isfile(source) and is_track(source):
        raise MediaError(
            source, "is a mesh track, which is solved already", "draw it with trimotion render"
        )
