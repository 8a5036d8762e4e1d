"""Files that appear under their name only when they are complete."""

import contextlib
import os
import platform
import re
import secrets
import shutil
import stat
from pathlib import Path

from warp_kernels.device.file_lock import locked
from warp_kernels.device.memory import MORE_MEMORY, is_out_of_memory
from warp_kernels.errors import OutputError

_HOST = re.sub(r"[^A-Za-z0-9]", "_", platform.node())[:40] or "host"
"""This machine: the numbers of its processes say nothing about those of others on a shared disk."""
_LEFT_OVER = re.compile(rf"\.trimotion-{_HOST}-(?P<process>\d+)-[0-9a-f]{{12}}\..*")

LOCK = re.compile(r"\.trimotion-[0-9a-f]{16}\.lock")
"""Names of the locks of outputs; one that nobody holds is left by a run that was killed."""


class PendingFile:
    """A file that is written beside its target and moved onto it at the end.

    A target that is a link is written through, even where it leads nowhere yet: the temporary file
    lies where the link points to.
    """

    def __init__(self, target: Path) -> None:
        """Choose a temporary name in the target's folder; nothing is created yet.

        Args:
            target: Name of the finished file.
        """
        self.target = true_place(target)
        name = f".trimotion-{_HOST}-{os.getpid()}-{secrets.token_hex(6)}.part"
        self.path = self.target.parent / name
        """Where to write."""

    def commit(self) -> None:
        """Force the file to the disk and move it onto the target.

        Raises:
            OutputError: If the disk or the folder refuses; the temporary file is then gone.
        """
        try:
            descriptor = os.open(self.path, os.O_RDWR)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
            refuse_special(self.target)
            os.replace(self.path, self.target)
            _sync_folder(self.target.parent)
        except OSError as error:
            self.discard()
            raise output_error(self.target, error) from error
        except OutputError:
            self.discard()
            raise

    def discard(self) -> None:
        """Remove the temporary file, if there is one."""
        self.path.unlink(missing_ok=True)


def true_place(target: Path) -> Path:
    """Where a file lies or will lie: the end of a chain of links, else the name itself.

    Args:
        target: Its name.
    """
    return Path(os.path.realpath(target)) if os.path.islink(target) else target


def refuse_special(target: Path) -> None:
    """Refuse to put a file where a device, a pipe or a socket is: it would take that away.

    Args:
        target: Name of the file.

    Raises:
        OutputError: If something else than a file stands there.
    """
    try:
        mode = target.stat().st_mode
    except OSError:  # nothing is there, or a link that leads nowhere or in a circle
        if not true_place(target).is_symlink():
            return
    else:
        if stat.S_ISREG(mode) or stat.S_ISDIR(mode):  # nothing is moved onto a folder
            return
    raise OutputError(target, "is no regular file", "give the name of a file")


def remove_left_overs(folder: Path) -> None:
    """Remove the temporary files of processes of this machine that were killed, and their locks.

    Args:
        folder: Where an output will be written.
    """
    if os.name != "posix":  # elsewhere a process cannot be asked whether it lives
        return
    try:
        entries = list(folder.iterdir())
    except OSError:
        return
    for entry in entries:
        match = _LEFT_OVER.fullmatch(entry.name)
        if match is not None and not _lives(int(match["process"])):
            with contextlib.suppress(OSError):  # another run removed it, or we may not
                shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
        elif LOCK.fullmatch(entry.name):
            with contextlib.suppress(OSError), entry.open("r+b") as file:
                if locked(file):
                    entry.unlink()


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass
    return True


def write_file(target: Path, content: bytes) -> None:
    """Write a whole file at once, or not at all.

    Args:
        target: Name of the file.
        content: All of its bytes.

    Raises:
        OutputError: If the disk or the folder refuses.
    """
    pending = PendingFile(target)
    try:
        pending.path.write_bytes(content)
    except OSError as error:
        pending.discard()
        raise output_error(target, error) from error
    except BaseException:
        pending.discard()
        raise
    pending.commit()


def output_error(target: Path, error: Exception) -> OutputError:
    """An error of the system or of FFmpeg while writing, in one line.

    Args:
        target: The file that was to be written.
        error: What was raised.
    """
    reason = str(getattr(error, "strerror", None) or error).strip().lower()
    if is_out_of_memory(error):
        return OutputError(target, "cannot be written (out of memory)", MORE_MEMORY)
    return OutputError(
        target, f"cannot be written ({reason})", "check the folder, its rights and the free space"
    )


def _sync_folder(folder: Path) -> None:
    """Make the new name itself survive a power cut; not every system can."""
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(descriptor)
    except OSError:
        pass
    finally:
        os.close(descriptor)
