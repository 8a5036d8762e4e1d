"""The command `trimotion`: parses, dispatches, and turns every error into one line.

Warp, OpenCV and FFmpeg are imported by the commands, after parsing: help and mistakes in an
option come at once.
"""

import argparse
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from pipeline.commands.crash_watch import end_watch, watch_for_crashes
from pipeline.commands.failure import report_failure, terminable
from pipeline.commands.inputs import inputs_of, joined, take
from pipeline.kept_memory import keep_memory, release_spare
from pipeline.printable import printable
from warp_kernels.device.memory import refuse_small_limit


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
    if argv is not None:  # it is called by a program that takes care of itself
        return _run(argv, commands)
    watch_for_crashes()
    keep_memory()
    try:
        return _run(sys.argv[1:], commands)
    finally:
        end_watch()


def _run(argv: Sequence[str], commands: "Mapping[str, Command] | None") -> int:
    """Parse, and do what is wanted; gives the exit code."""
    arguments = argparse.Namespace(command=None, debug=False)
    try:
        from pipeline.commands.grammar import build_parser

        parser = build_parser()
        if not argv:
            parser.print_help(sys.stderr)  # a script whose variable was empty must notice
            return 2
        parser.parse_args(joined(argv), arguments)
        with terminable(), _piped(arguments):
            if commands is None:
                if arguments.command in LOADING:
                    refuse_small_limit()
                _say_at_once(arguments)
            code = (commands or COMMANDS)[arguments.command](arguments)
            sys.stdout.flush()
    except SystemExit as request:
        return request.code if isinstance(request.code, int) else 2
    except BaseException as error:  # one place where every failure becomes a line and a code
        release_spare()
        if arguments.debug:
            traceback.print_exc()
        return report_failure(error, arguments)
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

    return convert_all(arguments, report_failure)


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
    from pipeline.progress import tell

    triangles, overwrite = arguments.triangles, arguments.overwrite
    draw_sheet(arguments.picture, arguments.sheet, triangles=triangles, overwrite=overwrite)
    tell(f"sheet of all styles: {arguments.sheet}", sys.stderr)


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
    from pipeline.commands.grammar import build_parser
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
    from pipeline.commands.grammar import build_parser

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

LOADING = (
    *("animate", "solve", "render", "edit", "preview", "plan", "join", "info", "measure"),
    *("listen", "doctor"),
)
"""Those that load libraries which take much memory."""
COMPILING = ("animate", "solve", "render")
"""Those that always launch kernels."""


def _print_anything() -> None:
    """Let names of files through that are not text in the terminal's encoding."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure: Any = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


if __name__ == "__main__":
    sys.exit(main())
