"""Ranges of whole shots: what separate runs, or separate machines, can solve on their own."""

import json
from dataclasses import dataclass, replace
from pathlib import Path

from pipeline.loop.motion import check_cuts, holds, open_around
from pipeline.loop.seam import with_return
from pipeline.loop.shots import with_shots
from pipeline.options.solve_options import SolveOptions
from stages.media import FrameRange
from warp_kernels.errors import OptionError

LEAD = 12
"""Frames over which a part of a shot warms up, and over which it may fade in."""


@dataclass(frozen=True)
class Plan:
    """Ranges that together are all of what is wanted."""

    source: Path
    """What will be solved."""
    shots: tuple[FrameRange, ...]
    """One range for each shot, in order."""
    ranges: tuple[FrameRange, ...]
    """Ranges of one shot or of several that follow each other, in order."""
    notes: tuple[str, ...] = ()
    """Choices that were made in reading the source, one sentence each."""

    @property
    def frames(self) -> int:
        """Number of frames; what two ranges have in common counts once."""
        return sum(map(_length, self.shots))

    def as_json(self, called: str) -> str:
        """All figures.

        Args:
            called: What the user calls the source.
        """
        return json.dumps(
            {
                "source": called,
                "frames": self.frames,
                "shots": [shot.first for shot in self.shots],
                "ranges": [_as_dict(part) for part in self.ranges],
            },
            indent=2,
        )

    def as_lines(self) -> str:
        """One range a line, as `--frames` takes it."""
        return "\n".join(map(str, self.ranges))


@dataclass(frozen=True)
class Pieces:
    """How long shots are cut into pieces that overlap.

    Raises:
        OptionError: If a number is impossible.
    """

    most: int
    """Frames that a piece may have, without its lead."""
    lead: int = LEAD
    """Frames before a piece that are solved with it: those in common with the one before."""

    def __post_init__(self) -> None:
        if self.lead < 1:
            raise OptionError(f"--lead {self.lead}: must be 1 or more")
        if self.most < 2 * self.lead:
            raise OptionError(
                f"--max-frames {self.most}: must be at least twice the {self.lead} frames of --lead"
            )


def plan(options: SolveOptions, parts: int | None = None, pieces: Pieces | None = None) -> Plan:
    """Find the shots of a source and share them out.

    Args:
        options: Say which frames of which source, and where cuts are.
        parts: Most ranges that are made, as even as whole shots allow; None for one a shot.
        pieces: How longer shots are cut; None for not at all.

    Raises:
        OptionError: If `parts` is below 1, or there is no frame.
        MediaError: If the source or the list of cuts cannot be read.
    """
    if parts is not None and parts < 1:
        raise OptionError(f"--parts {parts}: must be 1 or more")
    if parts is not None and pieces is not None:
        raise OptionError(f"--parts {parts}: --max-frames says where parts end; leave one out")
    if pieces is not None and options.frame_range.step != 1:
        raise OptionError(
            f"--max-frames {pieces.most}: takes every frame; leave x{options.frame_range.step} out"
        )
    starts: list[int] = []
    last = -1
    with open_around(options, None) as decoder:
        check_cuts(options.cuts, options.source, decoder.info)
        for seen in with_shots(with_return(decoder, options), options.cuts):
            if holds(options.frame_range, seen.frame, decoder.info):
                last = seen.frame.index
                if seen.opens_shot or not starts:
                    starts.append(last)
        notes = tuple(decoder.notes)
    step = options.frame_range.step
    ends = [*(start - step for start in starts[1:]), last]
    shots = tuple(FrameRange(a, b, step) for a, b in zip(starts, ends, strict=True))
    ranges = shots if parts is None else _shared(shots, parts)
    if pieces is not None:
        ranges = tuple(piece for shot in shots for piece in _cut(shot, pieces))
    return Plan(options.source, shots, ranges, notes)


def _cut(shot: FrameRange, pieces: Pieces) -> list[FrameRange]:
    """Pieces of a shot, as even as they can be; each but the first begins with its lead."""
    length = _length(shot)
    count = -(-length // pieces.most)
    begins = [shot.first + length * number // count for number in range(count)]
    ends = [*(begin - 1 for begin in begins[1:]), shot.last]
    leads = [0, *[pieces.lead] * (count - 1)]
    return [FrameRange(a - lead, b) for a, b, lead in zip(begins, ends, leads, strict=True)]


def _shared(shots: tuple[FrameRange, ...], parts: int) -> tuple[FrameRange, ...]:
    """Put shots together, each to the part in which its middle lies."""
    total = sum(map(_length, shots))
    ranges: dict[int, FrameRange] = {}
    before = 0
    for shot in shots:
        part = int((before + _length(shot) / 2) * parts / total)
        ranges[part] = replace(ranges.get(part, shot), last=shot.last)
        before += _length(shot)
    return tuple(ranges.values())


def _length(part: FrameRange) -> int:
    assert part.last is not None
    return (part.last - part.first) // part.step + 1


def _as_dict(part: FrameRange) -> dict[str, object]:
    return {
        "frames": str(part),
        "first": part.first,
        "last": part.last,
        "step": part.step,
        "count": _length(part),
    }
