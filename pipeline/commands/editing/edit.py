"""The editor: solves what is not solved yet, then serves the page."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeline.commands.convert import convert, progress_for
from pipeline.commands.importing import importing
from pipeline.progress import tell
from warp_kernels.errors import MediaError, OptionError

if TYPE_CHECKING:
    from pipeline.editor.serving.studio import Studio
    from pipeline.options.solve_options import SolveOptions

NEEDED = ("starlette", "uvicorn", "websockets")
"""Packages of the extra `editor`."""


def edit(arguments: argparse.Namespace) -> None:
    """Open a clip, a still or a track in the browser.

    Args:
        arguments: What the user gave; options that were left out are absent.

    Raises:
        OptionError: If the extra is not installed, or the address cannot be had.
        TrimotionError: If the source cannot be solved, or the track is damaged.
    """
    _check_installed()
    from pipeline.editor.serving.address import Address, listening

    listener = listening(arguments.host, arguments.port)
    with listener:
        track = _track(arguments)
        with importing():
            from pipeline.editor.serving.server import serve
        address = Address(arguments.host, listener.getsockname()[1])
        studio = _studio(arguments, track)

        def ready() -> None:
            """Say where the page is."""
            print(address.url, flush=True)
            if not arguments.quiet:
                _log(f"editing {track}; every edit is saved as it is made; Ctrl-C ends")

        serve(studio, address, listener, opens=not arguments.no_open, ready=ready)


def _check_installed() -> None:
    """Refuse to begin without the extra."""
    from importlib.util import find_spec

    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise OptionError(
            f"edit: the editor needs {', '.join(missing)}; pip install 'trimotion[editor]'"
        )


def _track(arguments: argparse.Namespace) -> Path:
    """The track that is edited; made now if there is none."""
    from pipeline.track import TrackReader, is_track

    source = Path(arguments.source)
    if is_track(source):
        return source
    track = Path(arguments.output or f"{source.stem}.mtrk")
    if not track.exists():
        given = {"command": "solve", "output": str(track), "preset": None, "debug": False}
        convert(argparse.Namespace(**{**_solving(arguments), **given}))
        return track
    with TrackReader(track) as reader:
        reader.header.source.check(source)
    return track


def _solving(arguments: argparse.Namespace) -> dict[str, Any]:
    """What a run of `solve` gets of the arguments."""
    own = ("host", "port", "no_open", "moved")
    return {key: value for key, value in vars(arguments).items() if key not in own}


def _studio(arguments: argparse.Namespace, track: Path) -> "Studio":
    """The track, opened."""
    from pipeline.editor.bench.session import Session
    from pipeline.editor.serving.studio import Studio
    from pipeline.options.run import Run
    from pipeline.track import TrackReader
    from warp_kernels.device.device import Device

    with TrackReader(track) as reader:
        options = _with_source(reader, arguments, track)
    with progress_for(arguments) as progress:
        name = getattr(arguments, "device", "auto")
        run = Run(name, getattr(arguments, "threads", 0))
        device = Device(run.device, run.threads, progress.kernels)
    return Studio(Session(track, options, device, run), _log)


def _with_source(reader: Any, arguments: argparse.Namespace, track: Path) -> "SolveOptions":
    """How a track was solved, with its source where that is now.

    Raises:
        TrackError: If what is there is another source.
        MediaError: If it is not there.
    """
    opened = Path(arguments.source)
    source = reader.header.source
    if opened == track and not (arguments.moved or source.is_file):
        raise MediaError(source.path, "the source of the track was no file", source.remedy)
    named = arguments.moved or (source.path if opened == track else opened)
    source.check(Path(named))
    options: SolveOptions = replace(reader.header.whole_solve, source=Path(named))
    return options


def _log(line: str) -> None:
    """A line for whoever looks at the terminal."""
    tell(line, sys.stderr)
