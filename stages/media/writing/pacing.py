"""When pictures are shown, and for how long, on the clock of a file."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from av.video.frame import VideoFrame


@dataclass(frozen=True, eq=False)
class Shown:
    """A picture and when it is shown."""

    frame: VideoFrame
    """The picture."""
    time: Fraction
    """When the source shows it [s]."""
    pts: int
    """When the file shows it [units of its clock]."""


class Pacing:
    """Holds a picture back until it is known how long it is shown.

    A picture that would be shown for too short a time is left out, unless there is time for it
    before the next one: then it is shown a little later. So the last of a burst is not lost, and
    of a steady stream every n-th picture is.
    """

    def __init__(self, shortest: int) -> None:
        """Start a film.

        Args:
            shortest: Least time for which a picture is shown [units of the file's clock]; where
                this is 1, pictures are moved by a unit and none is left out.
        """
        self.dropped = 0
        """Pictures that were left out."""
        self._shortest = shortest
        self._held: Shown | None = None
        self._waiting: Shown | None = None

    @property
    def held(self) -> Shown | None:
        """The picture that is held back."""
        return self._held

    def add(self, shown: Shown) -> Iterator[tuple[Shown, int]]:
        """Take a picture.

        Args:
            shown: The picture; its pts is where it would best be.

        Returns:
            The pictures that are settled by it, and for how long they are shown [units].
        """
        yield from self._settle(shown.pts)
        if self._held is None:
            self._held = shown
        elif shown.pts >= self._held.pts + self._shortest:
            yield self._held, shown.pts - self._held.pts
            self._held = shown
        elif self._shortest == 1:
            yield self._held, 1
            self._held = replace(shown, pts=self._held.pts + 1)
        else:
            self._waiting = shown

    def finish(self, end: int) -> Iterator[tuple[Shown, int]]:
        """Give what is left.

        Args:
            end: When the film ends [units].
        """
        yield from self._settle(end)
        if self._held is not None:
            yield self._held, max(self._shortest, end - self._held.pts)

    def _settle(self, pts: int) -> Iterator[tuple[Shown, int]]:
        """Show the picture that waits if there is time for it before the next one."""
        if self._held is None or self._waiting is None:
            return
        if pts >= self._held.pts + 2 * self._shortest:
            yield self._held, self._shortest
            self._held = replace(self._waiting, pts=self._held.pts + self._shortest)
        else:
            self.dropped += 1
        self._waiting = None
