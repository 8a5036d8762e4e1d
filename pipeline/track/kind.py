"""What is drawn of a track: a still, or a clip."""

import os
from pathlib import Path

from pipeline.track.reader import TrackReader, is_track
from warp_kernels.errors import TrimotionError


def is_of_a_still(path: Path) -> bool:
    """Whether a file is the track of a still.

    Args:
        path: A file; what cannot be read is none, and whoever opens it says what is wrong.
    """
    try:
        if not (os.path.isfile(path) and is_track(path)):
            return False
        with TrackReader(path) as track:
            return track.header.info.kind == "image"
    except TrimotionError:
        return False


def drawn_ending(path: Path) -> str:
    """Ending of what is drawn of a track, where its user names a folder.

    Args:
        path: The track.
    """
    return ".png" if is_of_a_still(path) else ".mp4"
