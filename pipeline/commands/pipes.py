"""Temporary files for what is none: `-` for standard input and standard output, and addresses.

Most formats must be read and written out of order, which a pipe cannot be.
"""

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from pipeline.commands.addresses import fetched, is_address, refuse_address
from pipeline.commands.inputs import PIPE, inputs_of, is_pipe
from pipeline.options.output_name import is_still
from pipeline.progress import hush, tell
from warp_kernels.errors import MediaError, OptionError, OutputError, TrimotionError

FORMATS = {"solve": ".mtrk", "join": ".mtrk", "preview": ".png", "listen": ".json"}
"""Ending of an output whose name does not say, by the command; PNG or Matroska for the others."""
REMEDY = "download the file and give its name"
"""What to do about an address that is not fetched."""
_MADE, _RECEIVED = "standard output", "standard input"


@contextmanager
def piped(arguments: argparse.Namespace) -> Iterator[None]:
    """Put files in place of pipes while a command runs, and send an output on after it.

    Args:
        arguments: What the user gave; names of pipes and addresses are replaced.

    Raises:
        MediaError: If nothing comes through the pipe, or an address is not allowed.
        OptionError: If standard input or output is asked for twice.
    """
    given = vars(arguments)
    inputs = [key for key in inputs_of(arguments) if given.get(key) == PIPE]
    output = given.get("output") or ""
    writes = is_pipe(output) and arguments.command not in ("measure", "plan")
    address = _address_in(arguments)
    if not inputs and not writes and address is None:
        yield
        return
    if arguments.command == "plan" and given["format"] not in ("text", "json"):
        what = "fetches this address" if address else "can read this pipe"
        raise OptionError(f"{address or PIPE}: no farm {what}; give the name of a file")
    if len(inputs) > 1:
        raise OptionError("-: standard input is one file; give the other one a name")
    if writes and given.get("progress") == "json":
        raise OptionError("-o -: standard output is taken by --progress json; choose another")
    with tempfile.TemporaryDirectory(prefix="trimotion-") as folder:
        received = Path(folder) / _RECEIVED
        for key in inputs:
            setattr(arguments, key, str(_received(received)))
        names = {received: PIPE}
        if address is not None:
            place = Path(folder) / "fetched"
            place.mkdir()
            _tell_of(arguments, address)
            source = fetched(address, place)
            names[source] = arguments.address = address
            setattr(arguments, _source_key(arguments), str(source))
        if not writes:
            with _told_as(names):
                yield
            return
        made = Path(folder) / f"{_MADE}{output[1:] or _ending_for(arguments)}"
        arguments.output = str(made)
        with _told_as({**names, made: output}):
            yield
        _send(made)


def _address_in(arguments: argparse.Namespace) -> str | None:
    """The address that is to be fetched, if the source is one.

    Raises:
        MediaError: If nobody allowed that, or nobody can.
        OptionError: If it is one of several inputs.
        OutputError: If the output is one.
    """
    given = vars(arguments)
    if is_address(given.get("output")):
        if arguments.command == "measure":  # which reads it
            raise MediaError(given["output"], "is an address", REMEDY)
        raise OutputError(given["output"], "is an address", "name a file")
    if "allow_url" not in arguments:
        for name in _read_by(arguments):
            if name is not None and is_address(name):
                raise MediaError(name, "is an address", REMEDY)
        return None
    inputs = given["inputs"] if "inputs" in given else [given[_source_key(arguments)]]
    named = [name for name in inputs if is_address(name)]
    if not named:
        return None
    if not arguments.allow_url:
        refuse_address(named[0])
    if len(inputs) > 1:
        raise OptionError(f"{named[0]}: an address is an input of its own; name it alone")
    return named[0]


def _tell_of(arguments: argparse.Namespace, address: str) -> None:
    """Say what is waited for: a film may take minutes, before any command says anything."""
    from pipeline.commands.convert import progress_for

    note = f"fetching {address}"
    if "progress" in arguments:
        with progress_for(arguments) as progress:
            progress.note(note)
    elif not getattr(arguments, "quiet", False):
        tell(f"trimotion: note: {note}", sys.stderr)


def _read_by(arguments: argparse.Namespace) -> list[str | None]:
    """Names of what a command reads that fetches nothing."""
    given = vars(arguments)
    keys = (*inputs_of(arguments), *(("check",) if arguments.command == "timeline" else ()))
    return [*(given.get(key) for key in keys), *given.get("inputs", []), *given.get("tracks", [])]


def _source_key(arguments: argparse.Namespace) -> str:
    """Where the name of the source stands; `info` reads a file of any kind."""
    return "file" if arguments.command == "info" else "source"


@contextmanager
def _told_as(names: Mapping[Path, str]) -> Iterator[None]:
    """Errors name what the user wrote: nobody knows the files in its place."""
    try:
        yield
    except TrimotionError as error:
        text = str(error)
        for path, name in names.items():
            text = text.replace(str(path), name)
        error.args = (text,)
        raise


def shown_name(path: Path) -> Path:
    """What a user calls a source or an output.

    Args:
        path: The file that is read or written.
    """
    return Path(PIPE) if path.stem in (_MADE, _RECEIVED) else path


def source_name(arguments: argparse.Namespace, path: Path) -> str:
    """What a user calls the source: `-`, its address, or the name of the file.

    Args:
        arguments: What the user gave, as `piped` changed it.
        path: The file that is read.
    """
    return getattr(arguments, "address", None) or str(shown_name(path))


def _ending_for(arguments: argparse.Namespace) -> str:
    """The format that suits what is written, where the user does not say it: a still is PNG."""
    if arguments.command in FORMATS:
        return FORMATS[arguments.command]
    if arguments.command != "render":
        return ".png" if is_still(Path(arguments.source)) else ".mkv"
    from pipeline.track.kind import is_of_a_still

    return ".png" if is_of_a_still(Path(arguments.track)) else ".mkv"


def _send(path: Path) -> None:
    """A file, to standard output.

    Raises:
        OutputError: If it leads to where there is no room.
    """
    try:
        with path.open("rb") as file:
            shutil.copyfileobj(file, sys.stdout.buffer)
        sys.stdout.buffer.flush()
    except BrokenPipeError:  # its reader has enough
        raise
    except OSError as error:
        hush(sys.stdout)  # what is still buffered must not fail again at the end
        reason = str(error.strerror or error).lower()
        raise OutputError(PIPE, f"cannot be written ({reason})", "make room for it") from error


def _received(path: Path) -> Path:
    """All that comes through standard input, as a file."""
    if sys.stdin is None or sys.stdin.isatty():
        raise MediaError(PIPE, "nothing is piped in", "write trimotion ... - < FILE")
    with path.open("wb") as file:
        shutil.copyfileobj(sys.stdin.buffer, file)
    return path
