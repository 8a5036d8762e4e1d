"""Faces over the frames of a shot: found now and then, followed between, never switched.

Faces are looked for in frames of fixed numbers, the keys; between two keys they move evenly. What
is known at a key follows from the frames of the shot up to `MEMORY` before it, whatever came before
those: a face that no search finds by itself is forgotten after `CARRIED` keys, and what was found
later never depends on what was found earlier. That is why a solution that goes on inside a shot
gives the bits of the whole.
"""

from dataclasses import dataclass, replace

import numpy as np

from stages.focus.face import Face, emphasis
from stages.focus.search import LIKELY, OPENING, PASSING, STILL, SURE, FaceSearch
from stages.focus.yunet import is_same
from stages.frame import Frame

SPACING = 4
"""Frames from one key to the next; at every second key the whole picture is searched."""
SEARCHED = 2 * SPACING
"""Frames from one search of the whole picture to the next."""
THOROUGH = 12 * SEARCHED
"""Frames from one search that also finds small faces to the next."""
CARRIED = THOROUGH // SPACING + 2
"""Most keys over which a face is followed that no search of the whole picture finds."""
MEMORY = SPACING * (CARRIED + 2) + SEARCHED
"""Frames before a key on which what is known there may depend."""
HELD = (1.0, 0.7, 0.35)
"""Share that a face keeps which was not found at one key, two and three in a row; then it is
gone."""


@dataclass(frozen=True, eq=False)
class _Known:
    """A face at a key."""

    face: Face
    """Where it is, or was last."""
    age: int = 0
    """Keys since a search of the whole picture found it by itself."""
    missed: int = 0
    """Keys in a row at which it was not found."""
    before: int | None = None
    """Place of the same face among those of the key before, if it was known there."""

    @property
    def shown(self) -> Face:
        """The face, and how much of it counts."""
        return self.face if not self.missed else replace(self.face, share=HELD[self.missed - 1])


class FaceTracks:
    """The faces of one shot, frame after frame.

    Args:
        search: Finds faces.
        size: Width and height of the frames [px].
        area: Of a triangle in the mean [px^2].
        step: Distance of the frames that are given, in numbers.
        is_still: Whether the source is a single picture, which is worth a longer search.
    """

    def __init__(
        self, search: FaceSearch, size: tuple[int, int], area: float, step: int, *, is_still: bool
    ) -> None:
        self._search = search
        self._size, self._area = size, area
        self._step = step
        self._opening = STILL if is_still else OPENING
        self._key: int | None = None
        self._known: list[_Known] = []
        self._likely: list[Face] = []
        self._waiting: list[int] = []
        self._faces: dict[int, list[Face]] = {}

    def see(self, frame: Frame, *, is_last: bool) -> None:
        """Take one more frame of the shot.

        Args:
            frame: The next frame.
            is_last: Whether the shot ends with it.
        """
        number = frame.index // self._step
        self._waiting.append(frame.index)
        if self._key is not None and number % SPACING and not is_last:
            return
        known = self._known_at(frame, number)
        for index in self._waiting:
            self._faces[index] = self._faces_at(index, frame.index, known)
        self._key, self._known, self._waiting = frame.index, known, []

    def knows(self, index: int) -> bool:
        """Whether enough has been seen for a frame.

        Args:
            index: Number of the frame.
        """
        return index in self._faces

    def added(self, index: int) -> np.ndarray | None:
        """What the faces add to the weights of a frame; to be asked once, when it is known.

        Args:
            index: Number of the frame.

        Returns:
            [H, W] float32, or None for nothing.
        """
        faces = self._faces.pop(index)
        return emphasis(faces, self._size, self._area) if faces else None

    def _known_at(self, frame: Frame, number: int) -> list[_Known]:
        """What is known at a key."""
        most = None
        if self._key is None:
            most = self._opening
        elif number % THOROUGH == 0:
            most = OPENING
        elif number % SEARCHED == 0:
            most = PASSING
        known, unsure = ([], []) if most is None else self._found(frame, most)
        old = sorted(enumerate(self._known), key=lambda entry: entry[1].age)
        for place, one in old:
            _carry(one, place, known, self._followed(one, frame, known, unsure))
        return known

    def _found(self, frame: Frame, most: float) -> tuple[list[_Known], list[Face]]:
        """What a search finds: faces, and what is one only where one was before."""
        found = self._search.everywhere(frame.pixels, most)
        before, self._likely = self._likely, [face for c, face in found if c >= LIKELY]
        known, unsure = [], []
        for certainty, face in found:
            if certainty >= SURE or (
                certainty >= LIKELY and any(is_same(face, other) for other in before)
            ):
                known.append(_Known(face))
            else:
                unsure.append(face)
        return known, unsure

    def _followed(
        self, one: _Known, frame: Frame, known: list[_Known], unsure: list[Face]
    ) -> Face | None:
        """Where a face of the key before is now; None if it is not seen."""
        if any(is_same(one.face, other.face) for other in known):
            return one.face
        for face in unsure:
            if is_same(one.face, face):
                return face
        return self._search.near(frame.pixels, one.face)

    def _faces_at(self, index: int, key: int, known: list[_Known]) -> list[Face]:
        """Faces of a frame: those of the keys before and after it, moved to its time."""
        if self._key is None or index == key:
            return [one.shown for one in known]
        share = (index - self._key) / (key - self._key)
        staying = {one.before for one in known}
        pairs = [(None if one.before is None else self._known[one.before], one) for one in known]
        going = [one for place, one in enumerate(self._known) if place not in staying]
        faces = [_between(before, one, share) for before, one in pairs]
        return faces + [_between(one, None, share) for one in going]


def _carry(one: _Known, place: int, known: list[_Known], face: Face | None) -> None:
    """Take a face over to the next key.

    Args:
        one: The face at the key before.
        place: Its place there.
        known: What is known at this key, the youngest first; updated.
        face: Where the face is now, or None.
    """
    found = one.face if face is None else face
    for number, other in enumerate(known):
        if is_same(found, other.face):
            if other.before is None:
                known[number] = replace(other, before=place)
            return
    missed = one.missed + 1 if face is None else 0
    if one.age < CARRIED and missed <= len(HELD):
        known.append(_Known(found, one.age + 1, missed, place))


def _between(before: _Known | None, after: _Known | None, share: float) -> Face:
    """A face between two keys; one that is known at one of them only swells or fades there.

    Args:
        before: The face at the key before, or None.
        after: The same at the key after, or None.
        share: How much of the time between them has passed [0..1].
    """
    if before is None or after is None:
        known, part = (after, share) if before is None else (before, 1.0 - share)
        assert known is not None
        return replace(known.shown, share=part * known.shown.share)
    one, other = before.shown, after.shown
    return Face(
        places=(1.0 - share) * one.places + share * other.places,
        size=(1.0 - share) * one.size + share * other.size,
        share=(1.0 - share) * one.share + share * other.share,
    )
