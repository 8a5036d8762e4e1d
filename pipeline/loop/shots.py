"""Where one shot ends and the next begins."""

from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from pipeline.envelope import InShot
from pipeline.track.cuts import read_cuts
from stages.flows.view import View
from stages.frame import Frame
from stages.metrics.signature import Signature, change, likeness, signature
from warp_kernels.errors import OptionError

Item = TypeVar("Item")

FLASH = 3
"""Longest flash or other interruption after which a shot goes on [frames]."""
AHEAD = FLASH + 1
"""Later frames that are looked at before a decision; one more than these of the earlier ones."""
LEAST = 8.0
"""Smallest change of a hard cut [code values]."""
RATIO = 3.0
"""A cut changes the picture this many times more than all but one of the steps before it that are
known, and than all but one of those after it: fades, dissolves and fast motion take several steps
of equal size. The one may be another cut."""
ALIKE = 0.7
"""Pictures of this likeness show the same things, displaced or in another light."""
CLEAR_RATIO, CLEARLY_ALIKE = 6.0, 0.78
"""A step so many times larger than others is a cut unless the pictures are as like as that:
plain pictures are alike by chance, but motion does not begin so suddenly."""


def with_shots(frames: Iterable[Frame], cuts: str) -> Iterator[InShot]:
    """Tell for every frame where its shot begins; the first one that is given begins one.

    Args:
        frames: Frames in order.
        cuts: "auto" to detect them, "none", or the path of a list.

    Raises:
        OptionError: If `cuts` is empty.
        MediaError: If the list cannot be read.
    """
    if not cuts:
        raise OptionError("--cuts '': use auto, none or the path of a list")
    if cuts == "auto":
        viewed = ((frame, View(frame.pixels)) for frame in frames)
        found = detected_shots(viewed, lambda seen: seen[0], lambda seen: seen[1])
        return (InShot(shot, frame, view=view) for (frame, view), shot in found)
    known = frozenset() if cuts == "none" else read_cuts(Path(cuts))
    return _listed(frames, known)


def _listed(frames: Iterable[Frame], cuts: frozenset[int]) -> Iterator[InShot]:
    """Obey a list; a cut at a frame that is skipped opens a shot with the next one."""
    ordered = sorted(cuts)
    before, shot = -1, 0
    for frame in frames:
        passed = bisect_right(ordered, frame.index)
        if passed > before:
            before, shot = passed, frame.index
        yield InShot(shot, frame)


def detected_shots(
    items: Iterable[Item], frame_of: Callable[[Item], Frame], view_of: Callable[[Item], View]
) -> Iterator[tuple[Item, int]]:
    """Find hard cuts; holds back as many items as a decision needs to look ahead.

    Args:
        items: Frames, or what comes with them, in order.
        frame_of: Gives the frame of an item.
        view_of: Gives the view of its picture.

    Yields:
        Every item, and the number of the frame with which its shot begins.
    """
    waiting: deque[Item] = deque()
    detector = _Detector()
    shot = 0

    def decided() -> tuple[Item, int]:
        """The item that has waited longest."""
        nonlocal shot
        item = waiting.popleft()
        if detector.decide():
            shot = frame_of(item).index
        return item, shot

    for item in items:
        detector.add(signature(view_of(item)))
        waiting.append(item)
        if len(waiting) > AHEAD:
            yield decided()
    while waiting:
        yield decided()


class _Detector:
    """Decides about frames in order, once `AHEAD` later ones are known or the clip ends."""

    def __init__(self) -> None:
        self._signatures: list[Signature] = []
        self._next = 0
        self._forgotten = False

    def add(self, description: Signature) -> None:
        """Tell of one more frame."""
        self._signatures.append(description)

    def decide(self) -> bool:
        """Whether the next undecided frame opens a shot; forgets what is not needed any more."""
        at = self._next
        opens = at == 0 and not self._forgotten
        if at > 0:
            opens = self._is_cut(at)
        self._next += 1
        surplus = self._next - (AHEAD + 1)
        if surplus > 0:
            del self._signatures[:surplus]
            self._next -= surplus
            self._forgotten = True
        return opens

    def _is_cut(self, at: int) -> bool:
        known = self._signatures
        before, after = known[at - 1], known[at]
        value = change(before, after)
        if value < LEAST:
            return False
        unrest = self._unrest(at)
        if value < RATIO * unrest:
            return False
        alike = ALIKE if value < CLEAR_RATIO * unrest else CLEARLY_ALIKE
        later = known[at : at + 1 + FLASH]
        earlier = known[max(0, at - 1 - FLASH) : at - 1]
        return not (_recurs(before, later, alike) or _recurs(after, earlier, alike))

    def _unrest(self, at: int) -> float:
        """Second largest change before or after a step, whichever is more [code values]."""
        known = self._signatures
        sides = (
            range(max(1, at - AHEAD), at),
            range(at + 1, min(len(known), at + 1 + AHEAD)),
        )
        changes = ([change(known[step - 1], known[step]) for step in side] for side in sides)
        return max(sorted([0.0, 0.0, *side])[-2] for side in changes)


def _recurs(picture: Signature, others: list[Signature], alike: float) -> bool:
    """Whether a picture is seen again among others: then what lies between interrupts a shot."""
    return any(likeness(picture, other) >= alike for other in others)
