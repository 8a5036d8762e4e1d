"""What `edit` takes."""

import argparse

from pipeline.options.values import text_value, whole_number

EDIT_ABOUT = (
    "Edit any frame in the browser, and the film follows. What is not solved yet is solved first, "
    "to a track in this folder; edits are saved in it as they are made."
)
EDIT_USAGE = "trimotion edit CLIP|STILL|JOB.mtrk [options]"


def add_edit_options(parser: argparse.ArgumentParser) -> None:
    """Give a parser the options of the editor itself.

    Args:
        parser: That of `edit`.
    """
    parser.add_argument(
        "source", metavar="CLIP|STILL|JOB.mtrk", type=text_value, help="what is edited"
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="JOB.mtrk",
        type=text_value,
        help="the track that is made, or gone on with (default: the name of the clip and .mtrk)",
    )
    parser.add_argument(
        "--source",
        dest="moved",
        metavar="INPUT",
        type=text_value,
        help="where the source of a track is now",
    )
    parser.add_argument(
        "--host",
        metavar="ADDRESS",
        type=text_value,
        default="127.0.0.1",
        help="address that is listened at; other machines can reach any but this (default: "
        "127.0.0.1)",
    )
    parser.add_argument(
        "--port", metavar="N", type=whole_number, default=0, help="its port (default: a free one)"
    )
    parser.add_argument("--no-open", action="store_true", help="open no browser")
