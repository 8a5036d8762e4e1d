"""Where one shot ends and the next begins."""

import json
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stages.frame import Frame
from stages.signature import change, signature
from warp_kernels.errors import MediaError, OptionError

AHEAD = 2
"""Frames looked at on either side of a possible cut."""
LEAST = 12.0
"""Smallest change of a hard cut [code values]."""
RATIO = 3.0
"""A cut changes the picture this many times more than the steps around it do."""
LASTING = 0.6
"""Part of the change that must last: still be there two frames later, as a flash goes away again,
and be there already two frames before, as the picture after a flash is the one before it."""


@dataclass(frozen=True, eq=False, slots=True)
class ShotFrame:
    """A frame and whether a shot begins with it."""

    frame: Frame
    """The frame."""
    opens_shot: bool
    """Whether the mesh starts anew here."""


def read_cuts(path: Path) -> frozenset[int]:
    """Read a list of cuts: JSON or plain text, the first frame of each new shot.

    Raises:
        MediaError: If the file cannot be read or holds something else.
    """
    remedy = "list the first frame of each new shot, as JSON [40, 76] or one number a line"
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise MediaError(path, f"the list of cuts cannot be read ({error})", remedy) from error
    try:
        numbers = json.loads(text) if text.lstrip().startswith("[") else text.split()
        cuts = frozenset(int(str(number)) for number in numbers)  # 2.5 and true are no frames
    except (ValueError, TypeError) as error:
        raise MediaError(path, f"is no list of cuts ({error})", remedy) from error
    if min(cuts, default=0) < 0:
        raise MediaError(path, f"a cut at frame {min(cuts)}", remedy)
    return cuts


def with_shots(frames: Iterable[Frame], cuts: str) -> Iterator[ShotFrame]:
    """Mark the frames with which shots begin.

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
        return _detected(frames)
    known = frozenset() if cuts == "none" else read_cuts(Path(cuts))
    return _listed(frames, known)


def _listed(frames: Iterable[Frame], cuts: frozenset[int]) -> Iterator[ShotFrame]:
    """Obey a list; a cut at a frame that is skipped opens a shot with the next one."""
    ordered = sorted(cuts)
    before: int | None = None
    for frame in frames:
        passed = bisect_right(ordered, frame.index)
        yield ShotFrame(frame, before is None or passed > before)
        before = passed


def _detected(frames: Iterable[Frame]) -> Iterator[ShotFrame]:
    """Hold back as many frames as a decision needs to look ahead."""
    waiting: list[Frame] = []
    detector = _Detector()
    for frame in frames:
        detector.add(signature(frame.pixels))
        waiting.append(frame)
        if len(waiting) > AHEAD:
            yield ShotFrame(waiting.pop(0), detector.decide())
    for frame in waiting:
        yield ShotFrame(frame, detector.decide())


class _Detector:
    """Decides about frames in order, once `AHEAD` later ones are known or the clip ends."""

    def __init__(self) -> None:
        self._signatures: list[np.ndarray] = []
        self._next = 0
        self._forgotten = False

    def add(self, description: np.ndarray) -> None:
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
        value = change(known[at - 1], known[at])
        if value < LEAST:
            return False
        steps = range(max(1, at - AHEAD), min(len(known), at + AHEAD + 1))
        around = [change(known[step - 1], known[step]) for step in steps if step != at]
        if around and value < RATIO * sum(around) / len(around):
            return False
        later = known[at : at + AHEAD + 1]
        earlier = known[max(0, at - AHEAD - 1) : at]
        steps_over = [change(known[at - 1], after) for after in later]
        steps_over += [change(before, known[at]) for before in earlier]
        return min(steps_over) >= LASTING * value
