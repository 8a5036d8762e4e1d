"""Weights of the frames of a clip, from what `--focus` names: nothing of it switches in time.

The weights of a frame follow from the frames of its shot up to `reach_of` around it, so ranges that
begin with a shot, a solution that goes on and `--jobs` give the bits of the whole.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from pipeline.envelope import InShot
from pipeline.loop.face_tracks import MEMORY, SPACING, FaceTracks
from stages.focus import Focus, Glance, spelled
from stages.focus.faces import Faces
from stages.focus.maps import enlarged
from stages.focus.search import FaceSearch
from stages.frame import Frame
from stages.media import MediaInfo

UNIT = 8
"""Weight of a pixel that counts once, so that an eighth can be told; the most is 255."""
GAIN = 4.0
"""What a map adds where it is 1."""
SMALL, AMPLE = 4.0, 12.0
"""Area of a triangle in the mean [px^2] up to which faces add nothing and from which all that they
can: where triangles are hardly larger than pixels, more of them fit no better."""
WINDOW = 6
"""Frames before and after one that a map is smoothed over, the nearer the more."""


class _Attending(Protocol):
    """One member of `--focus`, over the frames of one shot."""

    def see(self, frame: Frame, *, is_last: bool) -> None:
        """Take one more frame."""

    def knows(self, index: int) -> bool:
        """Whether what it adds to a frame can be told."""
        ...

    def added(self, index: int) -> np.ndarray | None:
        """What it adds to the weight 1 of every pixel, [h, w] float32, or None."""
        ...


class Attention:
    """Gives frames their weights.

    Args:
        members: What counts more; see `stages.focus.resolved`.
        info: The source.
        step: Distance of the frames that are given, in numbers.
        triangles: How many there will be.
        factor: By the number of a frame the factor of all that is added there.

    Raises:
        OptionError: If the network that finds faces is missing.
    """

    def __init__(
        self,
        members: Sequence[Focus],
        info: MediaInfo,
        step: int,
        triangles: int,
        factor: Callable[[int], float] = lambda index: 1.0,
    ) -> None:
        self._members = [m for m in members if isinstance(m, Faces | Glance)]
        self._info = info
        self._step = step
        self._factor = factor
        faces = any(isinstance(member, Faces) for member in members)
        self._search = FaceSearch() if faces else None
        self.notes: list[str] = []
        """What was found, one sentence each; complete once the last frame was given."""
        self._found = False
        self._area = info.width * info.height / max(1, triangles)
        self._room = min(max((self._area - SMALL) / (AMPLE - SMALL), 0.0), 1.0)
        self._spelled = spelled(members)

    def beside(self, frames: Iterable[InShot]) -> Iterator[InShot]:
        """Give frames their weights.

        Args:
            frames: Frames in order.
        """
        waiting: deque[InShot] = deque()
        parts: list[_Attending] = []
        # without members nothing is looked for, and no frame waits for the next one
        for seen, is_last in _with_ends(frames) if self._members else ():
            if seen.opens_shot or not parts:
                parts = [self._part(member) for member in self._members]
            for part in parts:
                part.see(seen.frame, is_last=is_last)
            waiting.append(seen)
            while waiting and all(part.knows(waiting[0].frame.index) for part in parts):
                known = waiting.popleft()
                yield replace(known, frame=self._weighed(known.frame, parts))
        if not self._members:
            yield from frames
        if self._search is not None:
            found = "faces found" if self._found else "no face found"
            self.notes.append(f"--focus {self._spelled}: {found}")
        elif self._spelled != "none":
            self.notes.append(f"--focus {self._spelled}")

    def _part(self, member: Focus) -> _Attending:
        """What a member becomes over one shot."""
        if isinstance(member, Glance):
            return _Glances(member)
        assert self._search is not None
        size = (self._info.width, self._info.height)
        is_still = self._info.kind == "image"
        return FaceTracks(self._search, size, self._area, self._step, is_still=is_still)

    def _weighed(self, frame: Frame, parts: Sequence[_Attending]) -> Frame:
        """A frame with the weights that all members together give it."""
        total: np.ndarray | None = None
        for member, part in zip(self._members, parts, strict=True):
            added = part.added(frame.index)
            if added is None:
                continue
            strength = member.strength
            if isinstance(member, Faces):
                self._found, strength = True, strength * self._room
            added = enlarged(np.float32(strength) * added, (frame.width, frame.height))
            total = added if total is None else total + added
        if total is None:
            return frame
        total = np.float32(self._factor(frame.index)) * total
        weights = np.minimum(np.rint(UNIT + UNIT * total), 255.0).astype(np.uint8)
        return frame if (weights == UNIT).all() else replace(frame, weights=weights)


class _Glances:
    """Maps of the frames of a shot, each smoothed over those around it."""

    def __init__(self, member: Glance) -> None:
        self._member = member
        self._maps: deque[tuple[int, np.ndarray]] = deque()
        self._before: Frame | None = None
        self._ended = False

    def see(self, frame: Frame, *, is_last: bool) -> None:
        """Take one more frame of the shot.

        Args:
            frame: The next frame.
            is_last: Whether the shot ends with it.
        """
        self._maps.append((frame.index, self._member.glance(self._before, frame)))
        self._before = frame
        self._ended = is_last

    def knows(self, index: int) -> bool:
        """Whether enough has been seen for a frame.

        Args:
            index: Number of the frame, which was seen.
        """
        return self._ended or self._place(index) + WINDOW < len(self._maps)

    def added(self, index: int) -> np.ndarray | None:
        """What the map adds to the weights of a frame; to be asked in order, once it is known.

        Args:
            index: Number of the frame.

        Returns:
            [h, w] float32 of any size, or None for nothing.
        """
        place = self._place(index)
        while place > WINDOW:
            self._maps.popleft()
            place -= 1
        total: np.ndarray = np.zeros((1, 1), dtype=np.float32)
        count = 0.0
        for other, (_, seen) in enumerate(self._maps):
            nearness = 1.0 - abs(other - place) / (WINDOW + 1)
            if nearness > 0:
                total = total + np.float32(nearness) * seen
                count += nearness
        return np.float32(GAIN / count) * total if total.any() else None

    def _place(self, index: int) -> int:
        return next(place for place, (other, _) in enumerate(self._maps) if other == index)


def reach_of(members: Iterable[Focus]) -> tuple[int, int]:
    """Frames before and after one on which its weights may depend.

    Args:
        members: What counts more.
    """
    before = after = 0
    for member in members:
        if isinstance(member, Faces):  # a frame later it is known whether the shot goes on
            before, after = max(before, MEMORY), max(after, SPACING + 1)
        elif isinstance(member, Glance):
            before, after = max(before, WINDOW + 1), max(after, WINDOW + 1)
    return before, after


def _with_ends(frames: Iterable[InShot]) -> Iterator[tuple[InShot, bool]]:
    """Frames, and whether their shot ends with them."""
    held: InShot | None = None
    for seen in frames:
        if held is not None:
            yield held, seen.opens_shot
        held = seen
    if held is not None:
        yield held, True
