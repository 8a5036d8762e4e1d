"""Where compiled kernels are kept, and whether there are any; known before Warp is imported.

It takes a second to import Warp, and a first run has something to say before that.
"""

import os
import sys
from pathlib import Path

VARIABLE = "WARP_CACHE_PATH"
"""Environment variable that says where; processes that are started later look at it, too."""
OURS = "*/wp_warp_kernels.*"
"""What lies in the folder of a version of Warp once a job has run."""


def cache_place() -> Path:
    """The folder that holds one of compiled kernels for every version of Warp, as Warp has it."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(os.path.realpath(named))
    if sys.platform == "win32":
        local = os.environ.get("LOCALAPPDATA") or "~/AppData/Local"
        return Path(local).expanduser() / "NVIDIA" / "warp" / "Cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/warp").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "warp"


def is_first_run() -> bool:
    """Whether nothing of this program was ever compiled here."""
    try:
        return next(cache_place().glob(OURS), None) is None
    except OSError:
        return True
