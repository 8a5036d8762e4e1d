"""What `plan` and `join` are given on the command line."""

import argparse

from pipeline.commands.inputs import add_allow_url
from pipeline.options.command_line import add_job_options
from pipeline.options.values import text_value, whole_number

PLAN_ABOUT = (
    "Print ranges of whole shots, one a line: solved apart and joined they are the whole. Or write "
    "the job of a farm that does this."
)
PLAN_USAGE = """\
trimotion plan INPUT [--parts N] [--json]
       trimotion plan INPUT --format ENGINE [-o JOB.mtrk] [options of solve] > SCRIPT"""
JOIN_ABOUT = "Put the tracks of ranges that follow each other together."
JOIN_USAGE = "trimotion join A.mtrk B.mtrk ... -o OUT.mtrk"
"""What the commands do, and how they are called."""

FORMATS = ("text", "json", "slurm", "openjd", "flamenco")
"""What `plan` prints."""


def add_plan_options(parser: argparse.ArgumentParser) -> None:
    """Give a parser what `plan` takes."""
    parser.add_argument("source", metavar="INPUT", type=text_value, help="what FFmpeg reads")
    add_allow_url(parser)
    parser.add_argument(
        "--parts", metavar="N", type=whole_number, help="at most so many (default: one a shot)"
    )
    parser.add_argument(
        "--max-frames",
        metavar="N",
        type=whole_number,
        help="cut longer shots, too: parts of at most so many frames, which join --blend N joins",
    )
    parser.add_argument(
        "--lead",
        metavar="N",
        type=whole_number,
        help="frames before such a part on which it warms up (default: 12)",
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument(
        "--format",
        choices=FORMATS,
        metavar="|".join(FORMATS),
        default="text",
        help="ranges, or the job of a farm: a script for Slurm, a template of Open Job "
        "Description, a job type for Flamenco (default: text)",
    )
    form.add_argument("--json", action="store_true", help="as --format json")
    parser.add_argument(
        "-o",
        "--output",
        metavar="JOB.mtrk",
        type=text_value,
        help="the track that a farm makes (default: the name of the input and .mtrk, in this "
        "folder)",
    )
    parser.add_argument("--preset", metavar="FILE.toml", type=text_value, help="options from it")
    add_job_options(parser, "plan")


def add_join_options(parser: argparse.ArgumentParser) -> None:
    """Give a parser what `join` takes."""
    parser.add_argument(
        "tracks", metavar="TRACK.mtrk", nargs="+", type=text_value, help="in any order"
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT.mtrk",
        type=text_value,
        required=True,
        help="the joined track",
    )
    parser.add_argument(
        "--blend",
        metavar="N",
        type=whole_number,
        default=0,
        help="let parts that overlap fade into each other over the last N frames (default: 0)",
    )
    parser.add_argument("--overwrite", action="store_true", help="replace an existing track")
    parser.add_argument("-q", "--quiet", action="store_true", help="tell errors only")
