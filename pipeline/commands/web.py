"""The option by which a source may be an address; it imports nothing that fetches."""

import argparse


def add_allow_url(parser: argparse.ArgumentParser, metavar: str = "INPUT") -> None:
    """Give a parser the option.

    Args:
        parser: That of a command.
        metavar: What its source is called.
    """
    parser.add_argument(
        "--allow-url",
        action="store_true",
        help=f"{metavar} may be an http or https address; it is fetched whole, to a temporary file",
    )
