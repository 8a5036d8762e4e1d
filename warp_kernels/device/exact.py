"""Arithmetic that rounds alike everywhere: the options of every kernel with a module of its own.

A kernel of `module="unique"` does not take over what its file sets for the file's module.
"""

from typing import Any

EXACT: dict[str, Any] = {"enable_backward": False, "fuse_fp": False}
"""No derivatives, and no multiplication fused with an addition: it would round once, where a
device without such an instruction rounds twice."""
