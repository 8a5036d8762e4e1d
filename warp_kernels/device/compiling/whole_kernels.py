"""Compiled kernels that were cut off, by a power cut or a full disk: they are compiled again."""

import shutil
import struct
from collections.abc import Callable, Iterable
from pathlib import Path

from warp_kernels.device.compiling.kernel_turn import waited_turn

ELF = b"\x7fELF\x02"
"""How an object file of Linux with 64 bits begins."""


def remove_broken(places: Iterable[Path], folder: Path, look: Callable[[], None]) -> None:
    """Remove folders of kernels in which a file was not written to its end.

    Args:
        places: Folders of compiled modules; some may not be there.
        folder: Where all of them lie.
        look: Called while another process compiles.
    """
    known = list(places)
    if all(map(is_whole, known)):
        return
    with waited_turn(folder, look):  # another process may have mended them by then
        for place in known:
            if not is_whole(place):
                shutil.rmtree(place, ignore_errors=True)


def is_whole(place: Path) -> bool:
    """Whether the object files of a module end where they say; one that is not there is whole.

    Args:
        place: The module's folder.
    """
    return all(map(_ends, place.glob("*.o")))


def _ends(path: Path) -> bool:
    """Whether a file holds the table of sections that its header names.

    Source: Tool Interface Standard, Executable and Linking Format 1.2, ELF header.
    """
    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(64)
    except OSError:
        return True  # another process takes it away
    if not head.strip(b"\0"):
        return False
    if not head.startswith(ELF) or len(head) < 64:
        return not head.startswith(ELF)  # of another system
    (table,) = struct.unpack_from("<Q", head, 40)
    length, count = struct.unpack_from("<HH", head, 58)
    return bool(table + length * count <= size)
