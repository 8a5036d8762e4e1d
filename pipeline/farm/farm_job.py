"""A film as a farm sees it: parts that are solved apart, and one step that joins them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stages.media import FrameRange


@dataclass(frozen=True)
class FarmJob:
    """Commands that together solve a film; every path in them is absolute."""

    source: Path
    """What is solved."""
    track: Path
    """The joined track. Those of the parts lie beside it."""
    ranges: tuple[FrameRange, ...]
    """The parts, in order."""
    options: tuple[str, ...] = ()
    """Options of `trimotion solve`, as words, but for the range."""
    blend: int = 0
    """Frames over which parts that overlap fade into each other."""
    replaces: bool = False
    """Whether a joined track that exists is replaced."""
    threads: int = 0
    """Threads of every part, 0 for as many as a machine of the farm gives."""

    @property
    def name(self) -> str:
        """What the job is called."""
        return self.track.stem

    @property
    def tracks(self) -> tuple[Path, ...]:
        """The tracks of the parts, in order."""
        return tuple(self.track.with_name(f"{self.name}.{part}.mtrk") for part in self.ranges)

    def solving(self, part: str, track: str) -> list[str]:
        """The words that solve a part; said once more, they go on with what is there.

        Args:
            part: Its range, or what stands for it in a script.
            track: Its track, or what stands for it.
        """
        words = ["solve", str(self.source), "-o", track, "--frames", part]
        return [*words, "--resume", "--progress", "plain", *self.options]

    def joining(self, tracks: Sequence[str]) -> list[str]:
        """The words that join the parts.

        Args:
            tracks: Their tracks, or what stands for all of them.
        """
        fade = ["--blend", str(self.blend)] if self.blend else []
        replace = ["--overwrite"] if self.replaces else []
        return ["join", *tracks, "-o", str(self.track), *fade, *replace]
