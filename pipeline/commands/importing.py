"""Imports of a command, without a look through all objects again and again."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def importing() -> Iterator[None]:
    """Let the collector rest while the block imports, and leave out later what it has found then.

    What is imported stays, some 200,000 objects: to look through them for what could go takes a
    tenth of the time of the imports, and of every frame later on. In a process that has imported
    Warp before, the program that did so takes care of itself.
    """
    if "warp" in sys.modules or not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
