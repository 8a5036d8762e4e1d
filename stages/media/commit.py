"""Files that appear under their name only when they are complete."""

import os
import secrets
from pathlib import Path

from warp_kernels.errors import OutputError


class PendingFile:
    """A file that is written beside its target and moved onto it at the end."""

    def __init__(self, target: Path) -> None:
        """Choose a temporary name in the target's folder; nothing is created yet.

        Args:
            target: Name of the finished file.
        """
        self.target = target
        self.path = target.parent / f".trimotion-{os.getpid()}-{secrets.token_hex(6)}.part"
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
            os.replace(self.path, self.target)
            _sync_folder(self.target.parent)
        except OSError as error:
            self.discard()
            raise output_error(self.target, error) from error

    def discard(self) -> None:
        """Remove the temporary file, if there is one."""
        self.path.unlink(missing_ok=True)


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
