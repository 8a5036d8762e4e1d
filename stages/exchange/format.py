"""What every format has in common."""

from collections.abc import Iterable
from pathlib import Path
from typing import ClassVar

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.solids.heights import depth_of
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES


class Format:
    """Takes frames and writes one file of them.

    A subclass says what it holds and overrides `add` and `save`. One object writes one file: where
    frames are numbered there is one for each.

    Args:
        film: What all frames have in common; it was checked.
    """

    styles: ClassVar[tuple[str, ...]] = ("flat",)
    """Names of the styles that it can hold."""
    most_degree: ClassVar[int] = 2
    """Degree of the colours that it can hold."""
    is_drawn: ClassVar[bool] = False
    """Whether it has a size on paper or screen, so that `--size` and what goes with it mean
    something; else positions are those in the source."""

    def __init__(self, film: Film) -> None:
        self.film = film
        self.notes: list[str] = []
        """Choices that were made, one sentence each."""

    @classmethod
    def check(cls, film: Film) -> None:
        """Find out, before any work is done, whether it can hold what is wanted.

        Args:
            film: What is wanted.

        Raises:
            OptionError: If it cannot.
        """
        refuse_styles(film, cls.styles)
        if not cls.is_drawn and film.framing.canvas != film.size:
            raise OptionError(
                f"--size, --scale: positions in {film.ending} are pixels of the source; leave them "
                "out"
            )
        film.options.refuse_idle(film.ending)
        relief = film.options.heights
        if relief is not None and relief.path is not None:
            depth_of(relief.path)
        if film.degree > cls.most_degree:
            raise OptionError(
                f"--color quadratic: {film.ending} holds no colours that bend; use --color linear, "
                "or .png"
            )

    def add(self, figure: Figure) -> None:
        """Take a frame.

        Args:
            figure: The frame; later than the one before.
        """
        raise NotImplementedError

    def save(self, path: Path) -> None:
        """Write what was taken.

        Args:
            path: The file; nothing is there yet.
        """
        raise NotImplementedError


def refuse_styles(film: Film, known: Iterable[str]) -> None:
    """Refuse styles that a format cannot hold.

    Args:
        film: What is wanted.
        known: Names of those that it can.

    Raises:
        OptionError: If there is another.
    """
    known = tuple(known)
    for style in film.styles:
        name = STYLES.name_of(type(style))
        if name not in known:
            raise OptionError(
                f"--style {name}: {film.ending} cannot hold it; use {', '.join(known)}, or .png"
            )
