"""Sources on the web, read only where the user says so: they are fetched whole, as files.

FFmpeg opens nothing but these files, so what an address leads to cannot name others.
"""

import re
import shutil
from pathlib import Path
from typing import IO, Any

from stages.media.writing.commit import output_error
from warp_kernels.errors import MediaError

SCHEMES = ("http", "https")
"""What is fetched; nothing leads from these to another one, or to a file."""
TIMEOUT = 30.0
"""Longest silence of a server [s]."""
BLOCK = 1 << 20
"""Bytes that are asked for at once."""
SPARED = 256 << 20
"""Bytes that are left free on the disk: a stream may have no end."""
LONGEST = 120
"""Letters of a name that are kept, its end."""

_NUMBER = re.compile(r"^\[errno -?\d+\] ")
"""What the system calls a failure, which tells a user nothing."""
_ADDRESS = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+)://")


def is_address(name: str | None) -> bool:
    """Whether a name is that of no file, but an address.

    Args:
        name: What the user wrote, or None.
    """
    return name is not None and _ADDRESS.match(name) is not None and not Path(name).exists()


def refuse_address(address: str) -> None:
    """Say what to do about an address that nobody allowed.

    Raises:
        MediaError: Always.
    """
    raise MediaError(address, "is an address", "add --allow-url to have it fetched")


def fetched(address: str, folder: Path) -> Path:
    """Fetch what an address leads to.

    Args:
        address: Where it is.
        folder: Where it goes, under the name that it has there; nothing else lies in it.

    Raises:
        MediaError: If the address is of another kind, or does not give all of a file.
        OutputError: If the folder takes no file.
    """
    known = _ADDRESS.match(address)
    if known is None or known[1].lower() not in SCHEMES:
        raise MediaError(address, "is an address of another kind", f"give {' or '.join(SCHEMES)}")
    from http.client import HTTPException

    try:
        with _opened(address) as answer:
            path = folder / _name_in(answer.url)
            _copy(answer, path, address)
    except (OSError, HTTPException, ValueError) as error:  # URLError is an OSError
        text = " ".join(str(getattr(error, "reason", None) or error).split()).lower()
        reason = _NUMBER.sub("", text)
        raise MediaError(address, f"cannot be fetched ({reason})", "check the address") from error
    return path


def _opened(address: str) -> Any:
    """The answer to a request; redirections lead to `SCHEMES` alone."""
    from urllib import request

    opener = request.OpenerDirector()
    for handler in (
        *(request.ProxyHandler, request.HTTPHandler, request.HTTPSHandler, request.UnknownHandler),
        *(request.HTTPRedirectHandler, request.HTTPErrorProcessor, request.HTTPDefaultErrorHandler),
    ):
        opener.add_handler(handler())
    opener.addheaders = [("User-Agent", "trimotion")]
    return opener.open(address, timeout=TIMEOUT)


def _copy(answer: Any, path: Path, address: str) -> None:
    """Write all that comes.

    Raises:
        MediaError: If the disk has no room for it.
        OutputError: If the disk refuses.
    """
    declared = answer.headers.get("Content-Length")
    try:
        file: IO[bytes] = path.open("xb")
    except OSError as error:
        raise output_error(path, error) from error
    with file:
        while block := answer.read(BLOCK):
            if shutil.disk_usage(path.parent).free < SPARED + len(block):
                remedy = "set TMPDIR to a folder on a larger disk, or download it"
                raise MediaError(address, f"does not fit into {path.parents[1]}", remedy)
            try:
                file.write(block)
            except OSError as error:
                raise output_error(path, error) from error
    if declared is not None and declared.isdecimal() and path.stat().st_size < int(declared):
        raise ValueError(f"it broke off after {path.stat().st_size} of {declared} bytes")


def _name_in(address: str) -> str:
    """A name of a file that says what it is; nothing in it leads elsewhere or is a pattern."""
    from urllib.parse import unquote, urlsplit

    name = Path(unquote(urlsplit(address).path)).name
    return re.sub(r"[^\w. -]", "_", name)[-LONGEST:].lstrip(". -") or "download"
