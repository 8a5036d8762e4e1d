"""The command `trimotion`: parses, dispatches, and turns every error into one line.

Warp, OpenCV and FFmpeg are imported by the commands, after parsing: help and mistakes in an
option come at once.
"""

import argparse
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any, NoReturn

from pipeline.commands.crash_watch import watch_for_crashes
from pipeline.commands.grammar import build_parser
from pipeline.commands.inputs import inputs_of, joined, take
from pipeline.kept_memory import keep_memory, release_spare
from pipeline.printable import one_line, printable

INTERRUPTED = 130
TERMINATED = 143


class Terminated(BaseException):
    """SIGTERM, raised in the main thread so that what is open cleans up after itself."""


def main(argv: Sequence[str] | None = None, commands: "Mapping[str, Command] | None" = None) -> int:
    """Run the command line.

    Args:
        argv: Arguments without the program's name; None for those of the process.
        commands: What each command runs; `COMMANDS` if left out.

    Returns:
        0 done, 1 failed, 2 usage, 3 input unreadable, 4 output cannot be written, 130 or 143
        interrupted.
    """
    _print_anything()
    if argv is None:  # else it is called by a program that takes care of itself
        watch_for_crashes()
    parser = build_parser()
    if not (sys.argv[1:] if argv is None else argv):
        parser.print_help(sys.stderr)  # a script whose variable was empty must notice
        return 2
    try:
        arguments = parser.parse_args(joined(sys.argv[1:] if argv is None else argv))
    except SystemExit as request:
        return request.code if isinstance(request.code, int) else 2
    try:
        if argv is None:
            keep_memory()
        with _terminable(), _piped(arguments):
            if commands is None:
                _say_at_once(arguments)
            code = (commands or COMMANDS)[arguments.command](arguments)
            sys.stdout.flush()
    except BaseException as error:  # one place where every failure becomes a line and a code
        release_spare()
        if arguments.debug:
            traceback.print_exc()
        return _report(error, arguments)
    return code or 0


def _say_at_once(arguments: argparse.Namespace) -> None:
    """On a first run, say that kernels will be compiled, before what takes a second to import."""
    from pipeline.commands.convert import progress_for
    from pipeline.commands.early_start import start_early
    from warp_kernels.device.cache_place import is_first_run

    if arguments.command in COMPILING and is_first_run():
        with progress_for(arguments) as progress:
            progress.kernels(0, None)
        start_early(arguments.command, getattr(arguments, "device", "auto"))


def _piped(arguments: argparse.Namespace) -> AbstractContextManager[None]:
    """Files in place of `-` and of addresses, if a name is one."""
    if "inputs" in arguments:
        take(arguments, arguments.inputs[0])
    keys = (*inputs_of(arguments), "output", "check")
    names = [getattr(arguments, key, None) or "" for key in keys]
    names += [*getattr(arguments, "inputs", []), *getattr(arguments, "tracks", [])]
    if not any(name.startswith("-") or "://" in name for name in names):
        return nullcontext()
    from pipeline.commands.pipes import piped

    return piped(arguments)


def run_conversion(arguments: argparse.Namespace) -> int:
    """Convert a source, or several; `solve` and `render` are done alike.

    Args:
        arguments: What the user gave; options that were left out are absent.
    """
    from pipeline.commands.several import convert_all

    return convert_all(arguments, _report)


def run_edit(arguments: argparse.Namespace) -> None:
    """Serve the editor.

    Args:
        arguments: What the user gave; options that were left out are absent.
    """
    from pipeline.commands.editing.edit import edit

    edit(arguments)


def run_preview(arguments: argparse.Namespace) -> None:
    """Draw a few moments.

    Args:
        arguments: What the user gave; options that were left out are absent.
    """
    from pipeline.commands.convert import preview_of

    print(printable(preview_of(arguments)))


def run_plan(arguments: argparse.Namespace) -> None:
    """Print ranges of whole shots, or the job of a farm.

    Args:
        arguments: What the user gave; options that were left out are absent.
    """
    from pipeline.commands.farm.plan import planned

    print(planned(arguments))


def run_join(arguments: argparse.Namespace) -> None:
    """Put tracks together.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.farm.join import join_tracks
    from pipeline.progress import tell

    parts = [Path(name) for name in arguments.tracks]
    joined = join_tracks(
        parts, Path(arguments.output), overwrite=arguments.overwrite, blend=arguments.blend
    )
    if not arguments.quiet:
        tell(joined, sys.stderr)


def run_info(arguments: argparse.Namespace) -> None:
    """Print what a file is.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.info import describe, edits_in
    from pipeline.commands.pipes import source_name

    path = Path(arguments.file)
    if arguments.edits:
        print(edits_in(path), end="")
    else:
        print(describe(path, as_json=arguments.json, called=source_name(arguments, path)))


def run_measure(arguments: argparse.Namespace) -> None:
    """Print how close an output is to its source, and how coherent.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.convert import progress_for
    from pipeline.compare.measure import measure
    from pipeline.options.build import frame_range

    track = None if arguments.track is None else Path(arguments.track)
    wanted = frame_range(vars(arguments))
    with progress_for(arguments) as progress:
        report = measure(Path(arguments.source), Path(arguments.output), wanted, track, progress)
    print(report.as_json() if arguments.json else report.as_table())


def run_styles(arguments: argparse.Namespace) -> None:
    """Print the styles, or draw them.

    Args:
        arguments: What the user gave.
    """
    if arguments.sheet is None:
        from pipeline.commands.styles.style_list import list_styles

        print(list_styles(arguments.picture, as_json=arguments.json))
        return
    from pipeline.commands.styles.style_sheet import draw_sheet

    triangles, overwrite = arguments.triangles, arguments.overwrite
    draw_sheet(arguments.picture, arguments.sheet, triangles=triangles, overwrite=overwrite)


def run_timeline(arguments: argparse.Namespace) -> None:
    """Print what a timeline does when, and draw it.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.timeline_check import check_timeline

    print(printable(check_timeline(arguments)))


def run_listen(arguments: argparse.Namespace) -> None:
    """Print what is heard in a sound, and write it.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.hearing.listen import listen_to

    told = listen_to(arguments)
    if told:
        print(printable(told))


def run_doctor(arguments: argparse.Namespace) -> int:
    """Print what this machine has, and whether a conversion works on it.

    Args:
        arguments: What the user gave.
    """
    import json

    from pipeline.commands.doctor import examine

    found = examine()
    print(json.dumps(found.as_dict(), indent=2) if arguments.json else found.as_lines())
    return 0 if found.works else 1


def run_completion(arguments: argparse.Namespace) -> None:
    """Print the script by which a shell completes the command line.

    Args:
        arguments: What the user gave.
    """
    from pipeline.commands.completion import SHELLS
    from pipeline.commands.completion.words import words_of
    from pipeline.timeline.timeline import shipped_timelines
    from stages.moves import MOVES
    from warp_kernels.styles import STYLES

    known = build_parser().commands()
    shipped = tuple(shipped_timelines())
    listed = {"help": tuple(known), "styles": (*STYLES, *MOVES), "timeline": shipped}
    print(SHELLS[arguments.shell](words_of(known, listed)), end="")


def run_help(arguments: argparse.Namespace) -> None:
    """Print the help of the program or of a command.

    Args:
        arguments: What the user gave.
    """
    parser = build_parser()
    known = parser.commands()
    if arguments.topic is None:
        parser.print_help()
    elif arguments.topic in known:
        known[arguments.topic].print_help()
    else:
        from pipeline.options.nearest import nearest
        from warp_kernels.errors import OptionError

        similar = nearest(arguments.topic, known)
        raise OptionError(f"help {arguments.topic}: no such command; {similar}")


Command = Callable[[argparse.Namespace], int | None]
"""A command is given what the user gave; it gives its exit code, None for 0."""
COMMANDS: dict[str, Command] = {
    "animate": run_conversion,
    "solve": run_conversion,
    "render": run_conversion,
    "edit": run_edit,
    "preview": run_preview,
    "plan": run_plan,
    "join": run_join,
    "info": run_info,
    "measure": run_measure,
    "styles": run_styles,
    "timeline": run_timeline,
    "listen": run_listen,
    "doctor": run_doctor,
    "completion": run_completion,
    "help": run_help,
}
"""What each subcommand runs."""

_OF_FILES = (FileNotFoundError, PermissionError, IsADirectoryError, NotADirectoryError)
"""What is a file's own fault, however little memory is left."""
COMPILING = ("animate", "solve", "render")
"""Those that always launch kernels."""


def _report(error: BaseException, arguments: argparse.Namespace) -> int:
    """Tell about a failure in one line.

    Args:
        error: What ended the command.
        arguments: What the user gave.

    Returns:
        The exit code.
    """
    from warp_kernels.device.memory import MORE_MEMORY, is_limit_near, is_out_of_memory
    from warp_kernels.errors import OptionError, TrimotionError

    # Under a limit libraries fail in ways of their own, and options that would fit do not.
    if (isinstance(error, OptionError) or _is_of_library(error)) and is_limit_near():
        return _fail(f"out of memory ({error}); {MORE_MEMORY}", 1)
    if isinstance(error, TrimotionError):
        return _fail(str(error), error.exit_code)
    if isinstance(error, KeyboardInterrupt):
        return _fail(f"interrupted; {_left_over(arguments)}", INTERRUPTED)
    if isinstance(error, Terminated):
        return _fail(f"terminated; {_left_over(arguments)}", TERMINATED)
    if isinstance(error, BrokenPipeError):
        # The reader of our output left. What is still buffered must not raise at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    kind = type(error).__name__
    if isinstance(error, Exception) and is_out_of_memory(error):
        reason = "" if isinstance(error, MemoryError) else f" ({kind}: {error})"
        return _fail(f"out of memory{reason}; {MORE_MEMORY}", 1)
    if isinstance(error, OSError) and error.filename and error.strerror:
        reason = error.strerror.lower()
        return _fail(f"{error.filename}: {reason}; check the place, its rights and free space", 1)
    return _fail(f"internal error ({kind}: {error}); run again with --debug and report it", 1)


def _is_of_library(error: BaseException) -> bool:
    """Whether a file is blamed for what a library said, which may have had another reason."""
    from warp_kernels.errors import MediaError, OutputError

    told_apart = isinstance(error, OutputError) or isinstance(error.__cause__, _OF_FILES)
    return isinstance(error, MediaError) and error.__cause__ is not None and not told_apart


def _left_over(arguments: argparse.Namespace) -> str:
    """What an interrupted command leaves."""
    if arguments.command == "solve" or (arguments.command == "animate" and "track" in arguments):
        return "the track keeps what was solved, and --resume goes on with it"
    return "no unfinished file is left"


def _fail(text: str, code: int) -> int:
    from pipeline.progress import tell

    tell(f"trimotion: error: {one_line(text)}", sys.stderr)
    return code


def _print_anything() -> None:
    """Let names of files through that are not text in the terminal's encoding."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure: Any = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


@contextmanager
def _terminable() -> Iterator[None]:
    """Raise `Terminated` on SIGTERM while the block runs."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGTERM, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


def _terminate(*_: object) -> NoReturn:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a second one must not disturb the clean-up
    raise Terminated


if __name__ == "__main__":
    sys.exit(main())
