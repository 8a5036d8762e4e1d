"""Photos in HEIF files (HEIC, AVIF): grids of tiles, crops, turns and masks.

FFmpeg hands over the coded pictures of such a file one by one; how they make the photo stands in
boxes of the file that it does not hand over.
"""

from stages.media.heif.compose import compose
from stages.media.heif.photo import Photo, read_photo

__all__ = ["Photo", "compose", "read_photo"]
