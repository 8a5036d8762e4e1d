"""The options of `trimotion listen`."""

import argparse

from pipeline.commands.inputs import add_allow_url
from pipeline.options.values import plain_number, text_value, whole_number

LISTEN_ABOUT = (
    "Find beats, bars, onsets and strengths of a sound: data for timelines, labels that a person "
    "corrects in Audacity, and a picture."
)
LISTEN_USAGE = (
    "trimotion listen SONG|CLIP [-o SONG.beats.json] [--labels FILE.txt] [--plot SOUND.png]"
)


def add_listen_options(parser: argparse.ArgumentParser) -> None:
    """Give a parser the options.

    Args:
        parser: That of the command.
    """
    parser.add_argument(
        "source", metavar="INPUT", type=text_value, help="a song, or a clip with sound"
    )
    add_allow_url(parser)
    files = (
        (("-o", "--output"), "SONG.beats.json", "write all that is heard, for timelines"),
        (("--labels",), "FILE.txt", "write beats as labels of Audacity"),
        (("--plot",), "SOUND.png", "write a picture of wave, beats, bars and onsets"),
        (("--beats",), "FILE", "beats, bars and sections are those of this file"),
    )
    for names, metavar, text in files:
        parser.add_argument(*names, metavar=metavar, type=text_value, help=text)
    parser.add_argument(
        "--bpm", metavar="N", type=plain_number, help="about the tempo, if you know it"
    )
    parser.add_argument(
        "--meter", metavar="N", type=whole_number, help="beats of a bar (default: 4)"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace existing files")
    parser.add_argument("--json", action="store_true", help="print all that is heard as JSON")
    parser.add_argument("-q", "--quiet", action="store_true", help="tell errors only")
