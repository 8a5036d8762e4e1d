"""Where a film that loops is closed: which frames are blended into which."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Seam:
    """The frames of a loop, and those that lead over from its last to its first one.

    A film that leads into itself is solved beyond its end, where its first pictures follow once
    more: the meshes that come from its end fade into those with which it begins. Any other one
    fades, over its last frames, into the frames that come before its first one.
    """

    over: int = 0
    """Frames over which it is blended; 0 for no loop."""
    opens: int = 0
    """Number of the first frame that is shown."""
    closes: int = 0
    """Number of the last one."""
    is_own: bool = False
    """Whether the film leads into itself."""

    @property
    def solved(self) -> tuple[int, int]:
        """Numbers of the first and the last frame that are solved."""
        if self.is_own:
            return self.opens, self.closes + self.over
        return self.opens - self.over, self.closes

    def partner_of(self, frame: int) -> tuple[int, float] | None:
        """What is blended into a frame that is shown.

        Args:
            frame: Its number.

        Returns:
            The number of another frame that is solved, and how much of it; None for nothing.
        """
        if self.is_own:
            place = frame - self.opens
            if 0 <= place < self.over:
                return self.closes + 1 + place, 1.0 - (place + 1) / (self.over + 1)
            return None
        place = frame - (self.closes - self.over + 1)
        if 0 <= place < self.over and frame <= self.closes:
            return self.opens - self.over + place, (place + 1) / (self.over + 1)
        return None

    def picture_of(self, frame: int) -> int:
        """The number of the picture of the source that a solved frame shows."""
        if self.over and self.is_own and frame > self.closes:
            return self.opens + frame - self.closes - 1
        return frame

    @property
    def note(self) -> str:
        """What is told of it."""
        shown = f"--loop {self.over}: frames {self.opens} to {self.closes}"
        if self.is_own:
            return f"{shown} lead into themselves; their meshes are matched over the seam"
        return (
            f"{shown} do not lead into themselves; the last {self.over} fade into those before "
            f"frame {self.opens}"
        )
