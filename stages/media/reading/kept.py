"""Objects of PyAV that must never end, because ending they would free what is not theirs.

PyAV 18.1 wraps some memory of FFmpeg's without a copy and frees it with the wrapper, and FFmpeg
frees it again: the process aborts. A wrapper that never ends frees nothing. It costs some 60 bytes.
"""

import ctypes
from typing import Any


def keep(wrapper: Any) -> None:
    """Let an object live as long as the process, its end included.

    Args:
        wrapper: The object.
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(wrapper))
