"""Lists of cuts: the first frame of each new shot, as a file of the user says."""

import json
from pathlib import Path

from stages.media.text_file import read_text, reason_of
from warp_kernels.errors import MediaError


def read_cuts(path: Path) -> frozenset[int]:
    """Read a list of cuts: JSON or plain text, the first frame of each new shot.

    Raises:
        MediaError: If the file cannot be read or holds something else.
    """
    remedy = "list the first frame of each new shot, as JSON [40, 76] or one number a line"
    try:
        text = read_text(path)
    except (OSError, ValueError) as error:
        raise MediaError(
            path, f"the list of cuts cannot be read ({reason_of(error)})", remedy
        ) from error
    try:
        numbers = json.loads(text) if text.lstrip().startswith("[") else text.split()
        cuts = frozenset(int(str(number)) for number in numbers)  # 2.5 and true are no frames
    except (ValueError, TypeError, RecursionError) as error:
        raise MediaError(path, "is no list of whole numbers", remedy) from error
    if min(cuts, default=0) < 0:
        raise MediaError(path, f"a cut at frame {min(cuts)}", remedy)
    return cuts
