"""Where a film that loops is closed, or parts of it meet: which frames are blended into which."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Seam:
    """The frames of a loop, and those that lead over from its last to its first one.

    A film that leads into itself is solved beyond its end, where its first pictures follow once
    more: the meshes that come from its end fade into those with which it begins. Any other one
    fades, over its last frames, into the frames that come before its first one.

    Where parts of a shot were solved apart and joined, the last frames of the one that goes stand
    behind the end, joint after joint, and fade into those that are shown in their place.
    """

    over: int = 0
    """Frames over which it is blended; 0 for no loop."""
    opens: int = 0
    """Number of the first frame that is shown."""
    closes: int = 0
    """Number of the last one."""
    is_own: bool = False
    """Whether the film leads into itself."""
    joints: tuple[int, ...] = ()
    """The first frames that are shown of parts that were joined; empty for a loop."""

    def __post_init__(self) -> None:
        """Refuse what no track has: a stranger's header is read into this."""
        if not self.joints:
            return
        ends = [*self.joints[1:], self.closes + 1]
        gaps = (end - first for first, end in zip(self.joints, ends, strict=True))
        if self.over < 1 or self.joints[0] < self.opens or any(gap < self.over for gap in gaps):
            raise ValueError("parts that meet at impossible frames")

    @property
    def solved(self) -> tuple[int, int]:
        """Numbers of the first and the last frame that are solved."""
        if self.is_own or self.joints:
            return self.opens, self.closes + self.over * max(1, len(self.joints))
        return self.opens - self.over, self.closes

    def partner_of(self, frame: int) -> tuple[int, float] | None:
        """What is blended into a frame that is shown.

        Args:
            frame: Its number.

        Returns:
            The number of another frame that is solved, and how much of it; None for nothing.
        """
        for number, first in enumerate(self.joints):
            place = frame - first
            if 0 <= place < self.over:
                shown = self.closes + 1 + number * self.over + place
                return shown, 1.0 - (place + 1) / (self.over + 1)
        if self.joints:
            return None
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
        if self.joints and frame > self.closes:
            number, place = divmod(frame - self.closes - 1, self.over)
            return self.joints[number] + place
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
