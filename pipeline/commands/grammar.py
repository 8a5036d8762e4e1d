"""The grammar of the command line: subcommands, their arguments, their help."""

import argparse
import re
from typing import Any, NoReturn

from pipeline.commands.editing.grammar import EDIT_ABOUT, EDIT_USAGE, add_edit_options
from pipeline.commands.examples import ABOUT_ALL, EXAMPLES, shown
from pipeline.commands.farm.grammar import (
    JOIN_ABOUT,
    JOIN_USAGE,
    PLAN_ABOUT,
    PLAN_USAGE,
    add_join_options,
    add_plan_options,
)
from pipeline.commands.hearing.grammar import LISTEN_ABOUT, LISTEN_USAGE, add_listen_options
from pipeline.commands.inputs import add_allow_url
from pipeline.commands.overview import COMMANDS_HELP
from pipeline.commands.styles.style_list import registry_help
from pipeline.commands.unknown import no_command, unknown_arguments
from pipeline.options.command_line import add_job_options
from pipeline.options.values import text_value, whole_number
from pipeline.printable import one_line
from pipeline.progress import CHOICES

ABOUT = "Turn videos into coherent triangulated animations."

WHERE_PARAMETERS = """\
trimotion styles lists every style and move with its parameters, trimotion styles NAME those of one.

"""


_CHOICE = re.compile(r"argument COMMAND: invalid choice: '(.*)' \(choose from ")


class OneLineParser(argparse.ArgumentParser):
    """A parser whose errors are one line that ends with a remedy."""

    def error(self, message: str) -> NoReturn:
        """Print a mistake and leave with exit code 2."""
        found = _CHOICE.match(message)
        if found:
            message = no_command(found[1], self.commands())
        line = one_line(message.removeprefix("argument "))
        self.exit(2, f"trimotion: error: {line}; see {self.prog} --help\n")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuse unknown options here, where the similar ones are known."""
        found, unknown = super().parse_known_args(args, namespace)
        command = self.get_default("command")
        if unknown and command:
            self.error(unknown_arguments(unknown, list(self._option_string_actions), command))
        return found, unknown

    def options(self) -> list[argparse.Action]:
        """Its options and arguments, for which argparse has no public name."""
        return list(self._actions)

    def commands(self) -> dict[str, argparse.ArgumentParser]:
        """The parsers of its commands, by name."""
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                return dict(action.choices)
        return {}


class _Version(argparse.Action):
    """Prints the version, which takes a while to find, only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        from pipeline.version import program_version

        print(f"trimotion {program_version()}")
        parser.exit()


def build_parser() -> OneLineParser:
    """Make the parser; options of a job that were not given are absent from its result."""
    parser = OneLineParser(
        prog="trimotion",
        description=ABOUT,
        usage="trimotion COMMAND ... ",
        epilog=COMMANDS_HELP + shown(ABOUT_ALL),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("-V", "--version", action=_Version, nargs=0, help="print the version")
    parser.add_argument("--debug", action="store_true", help="show where an error arose")
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, help=argparse.SUPPRESS
    )
    _add_animate(commands)
    _add_solve(commands)
    _add_render(commands)
    _add_edit(commands)
    _add_preview(commands)
    _add_plan(commands)
    _add_join(commands)
    _add_info(commands)
    _add_measure(commands)
    _add_styles(commands)
    _add_timeline(commands)
    _add_listen(commands)
    _add_doctor(commands)
    _add_completion(commands)
    _add_help(commands)
    return parser


def _add_animate(commands: Any) -> None:
    parser = _command(
        commands,
        "animate",
        "Convert a video, a still or numbered stills (shot_####.png) into triangles; several of "
        "them, or what a folder holds, into a folder.",
        "trimotion animate INPUT -o OUTPUT [options]\n"
        "       trimotion animate INPUT ... -o FOLDER/ [options]",
        registry_help() + "\n\n" + WHERE_PARAMETERS,
    )
    _add_inputs(parser, "INPUT", "what FFmpeg reads, or a folder of it")
    _add_output(
        parser, "OUTPUT", "mp4, mov, mkv, webm, gif, a still, or stills such as shot_####.png"
    )
    add_allow_url(parser)
    add_job_options(parser, "animate")
    _add_messages(parser)


def _add_solve(commands: Any) -> None:
    parser = _command(
        commands,
        "solve",
        "Convert a source to a mesh track. A run that is killed goes on with --resume.",
        "trimotion solve INPUT -o JOB.mtrk [options]\n"
        "       trimotion solve INPUT ... -o FOLDER/ [options]",
    )
    _add_inputs(parser, "INPUT", "what FFmpeg reads, or a folder of it")
    _add_output(parser, "JOB.mtrk", "the mesh track")
    add_allow_url(parser)
    add_job_options(parser, "solve")
    _add_messages(parser)


def _add_render(commands: Any) -> None:
    parser = _command(
        commands,
        "render",
        "Draw a mesh track, or a part of it, in any style and size.",
        "trimotion render JOB.mtrk -o OUTPUT [options]\n"
        "       trimotion render JOB.mtrk ... -o FOLDER/ [options]",
        WHERE_PARAMETERS,
    )
    _add_inputs(parser, "JOB.mtrk", "a mesh track, or a folder of them")
    _add_output(parser, "OUTPUT", "what animate writes")
    parser.add_argument(
        "--source", metavar="INPUT", type=text_value, help="where the source is now"
    )
    add_job_options(parser, "render")
    _add_messages(parser)


def _add_edit(commands: Any) -> None:
    parser = _command(commands, "edit", EDIT_ABOUT, EDIT_USAGE)
    add_edit_options(parser)
    add_job_options(parser, "edit")
    _add_telling(parser.add_argument_group("messages"))


def _add_preview(commands: Any) -> None:
    parser = _command(
        commands,
        "preview",
        "Draw five moments of what animate would make, with the time that it would take.",
        "trimotion preview INPUT [-o SHEET.png] [options of animate]",
        WHERE_PARAMETERS,
    )
    parser.add_argument("source", metavar="INPUT", type=text_value, help="what FFmpeg reads")
    parser.add_argument(
        "-o",
        "--output",
        metavar="SHEET.png",
        type=text_value,
        help="a still (default: the name of the input and .preview.png, in this folder)",
    )
    parser.add_argument("--json", action="store_true", help="print figures as JSON")
    add_allow_url(parser)
    add_job_options(parser, "preview")
    _add_messages(parser)


def _add_plan(commands: Any) -> None:
    parser = _command(commands, "plan", PLAN_ABOUT, PLAN_USAGE)
    add_plan_options(parser)


def _add_join(commands: Any) -> None:
    parser = _command(commands, "join", JOIN_ABOUT, JOIN_USAGE)
    add_join_options(parser)


def _add_inputs(parser: argparse.ArgumentParser, metavar: str, text: str) -> None:
    parser.add_argument("inputs", metavar=metavar, nargs="+", type=text_value, help=text)


def _add_output(parser: argparse.ArgumentParser, metavar: str, text: str) -> None:
    parser.add_argument(
        "-o",
        "--output",
        dest="output",
        metavar=metavar,
        type=text_value,
        required=True,
        help=text,
    )


def _add_messages(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("presets and messages")
    group.add_argument(
        "--preset",
        metavar="FILE.toml",
        type=text_value,
        help="options from a file, or a shipped one: preview, fine; the command line beats it",
    )
    _add_telling(group)


def _add_telling(group: Any) -> None:
    group.add_argument(
        "--progress",
        choices=CHOICES,
        metavar="|".join(CHOICES),
        default="auto",
        help="auto is a bar on a terminal, else plain lines (default: auto)",
    )
    group.add_argument("-q", "--quiet", action="store_true", help="tell warnings and errors only")
    group.add_argument(
        "-v",
        "--verbose",
        action="store_true",
        help="tell choices that were made, even with --progress none",
    )


def _add_info(commands: Any) -> None:
    parser = _command(
        commands, "info", "Print what a file is.", "trimotion info FILE [--json|--edits]"
    )
    parser.add_argument(
        "file", metavar="FILE", type=text_value, help="a mesh track or what FFmpeg reads"
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print JSON")
    form.add_argument(
        "--edits",
        action="store_true",
        help="print the edits by hand that a track holds, as --edits of solve reads them",
    )
    add_allow_url(parser, "FILE")


def _add_measure(commands: Any) -> None:
    parser = _command(
        commands,
        "measure",
        "Compare an output with its source: rmse [code values], PSNR, R (Eq. 12), E_warp and tOF; "
        "with a track also what its meshes do.",
        "trimotion measure SOURCE OUTPUT [--track JOB.mtrk] [--json]",
    )
    parser.add_argument("source", metavar="SOURCE", type=text_value, help="what was converted")
    parser.add_argument("output", metavar="OUTPUT", type=text_value, help="what came out")
    parser.add_argument(
        "--track",
        metavar="JOB.mtrk",
        type=text_value,
        help="what the output was drawn from; its frames are compared if no range is given",
    )
    parser.add_argument("--json", action="store_true", help="print JSON, with every frame")
    add_allow_url(parser, "SOURCE")
    add_job_options(parser, "measure")
    _add_telling(parser.add_argument_group("messages"))


def _add_styles(commands: Any) -> None:
    parser = _command(
        commands,
        "styles",
        "Print all styles with their parameters, or one, or draw one portrait in every style.",
        "trimotion styles [NAME] [--json]\n       trimotion styles [PICTURE] --sheet OUT.png",
    )
    parser.add_argument(
        "picture",
        metavar="NAME|PICTURE",
        nargs="?",
        type=text_value,
        help="the style that is told of; with --sheet what is drawn (default: the portrait among "
        "the sample clips)",
    )
    parser.add_argument(
        "--sheet", metavar="OUT.png", type=text_value, help="write a picture of all styles"
    )
    parser.add_argument(
        "--triangles", metavar="N", type=whole_number, default=900, help="triangles of the sheet"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace an existing sheet")
    parser.add_argument("--json", action="store_true", help="print JSON")


def _add_timeline(commands: Any) -> None:
    parser = _command(
        commands,
        "timeline",
        "Print what a timeline does when, and draw it above the film; nothing is solved.",
        "trimotion timeline SHOW.toml|NAME --check CLIP [-o STRIP.png]\n"
        "       trimotion timeline NAME",
    )
    parser.add_argument("show", metavar="SHOW.toml|NAME", type=text_value, help="the timeline")
    parser.add_argument(
        "--check",
        dest="source",
        metavar="CLIP",
        type=text_value,
        help="the film; without it the text of a shipped timeline is printed",
    )
    parser.add_argument(
        "-o", "--output", metavar="STRIP.png", type=text_value, help="write a picture of it"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace an existing picture")
    parser.add_argument("--json", action="store_true", help="print JSON")
    add_job_options(parser, "timeline")


def _add_listen(commands: Any) -> None:
    parser = _command(commands, "listen", LISTEN_ABOUT, LISTEN_USAGE)
    add_listen_options(parser)


def _add_doctor(commands: Any) -> None:
    parser = _command(
        commands,
        "doctor",
        "Print what this machine has that conversions need, and make a small film on it; exit code "
        "1 if that does not work.",
        "trimotion doctor [--json]",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def _add_completion(commands: Any) -> None:
    parser = _command(
        commands,
        "completion",
        "Print a script by which a shell completes commands, options, values and files.",
        "trimotion completion bash|zsh|fish",
    )
    parser.add_argument(
        "shell", metavar="bash|zsh|fish", choices=("bash", "zsh", "fish"), help="the shell"
    )


def _add_help(commands: Any) -> None:
    parser = _command(
        commands, "help", "Print what the program or a command does.", "trimotion help [COMMAND]"
    )
    parser.add_argument(
        "topic", metavar="COMMAND", nargs="?", type=text_value, help="one of the commands"
    )


def _command(
    commands: Any, name: str, description: str, usage: str, more: str = ""
) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        prog=f"trimotion {name}",
        description=description,
        usage=usage,
        epilog=more + shown(EXAMPLES[name]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    # absent if not given: it may have been given before the command
    parser.add_argument(
        "--debug",
        action="store_true",
        default=argparse.SUPPRESS,
        help="show where an error arose",
    )
    parser.set_defaults(command=name)
    return parser
