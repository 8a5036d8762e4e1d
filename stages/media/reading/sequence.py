"""Numbered stills as frames."""

import gc
from collections.abc import Iterator

from av.video.frame import VideoFrame

from stages.media.frame_range import FrameRange
from stages.media.naming import NumberedPattern
from stages.media.reading.read_options import ReadOptions
from stages.media.reading.source import VideoSource
from warp_kernels.errors import MediaError


def existing_numbers(pattern: NumberedPattern) -> list[int]:
    """Frame numbers of the stills that exist, in ascending order.

    Args:
        pattern: Their name.

    Raises:
        MediaError: If there is none.
    """
    numbers = pattern.numbers()
    if not numbers:
        other = pattern.taking_all() if pattern.left_out() else None
        raise MediaError(
            pattern.text,
            f"no still such as {pattern.path_for(1).name}",
            f"write {other}" if other else "check the name and the number of digits",
        )
    return numbers


def note_on_left_out(pattern: NumberedPattern) -> list[str]:
    """Tell of stills that a pattern misses because their numbers have other digits.

    Args:
        pattern: The stills' name.

    Returns:
        One sentence, or none.
    """
    others = pattern.left_out()
    if not others:
        return []
    named = " and ".join(others) if len(others) < 3 else f"{others[0]} to {others[-1]}"
    stills = "1 still is" if len(others) == 1 else f"{len(others)} stills are"
    all_of = pattern.taking_all()
    remedy = f"; {all_of} takes all" if all_of else ""
    return [f"{stills} left out, whose numbers have other digits ({named}){remedy}"]


def refuse_gaps(pattern: NumberedPattern, numbers: list[int], wanted: FrameRange) -> None:
    """Refuse a sequence with missing stills: they would pass as a jump in the motion.

    Args:
        pattern: The stills' name.
        numbers: The frame numbers that exist, ascending.
        wanted: The frames asked for; a gap outside them does not matter.

    Raises:
        MediaError: If a still that is asked for is missing.
    """
    first = max(wanted.first, numbers[0])
    first += (wanted.first - first) % wanted.step
    last = numbers[-1] if wanted.last is None else min(wanted.last, numbers[-1])
    expected = range(first, last + 1, wanted.step)
    present = [number for number in numbers if number in expected]
    if len(present) < len(expected):
        pairs = zip(expected, [*present, -1], strict=False)
        missing = next(number for number, found in pairs if number != found)
        raise MediaError(
            pattern.path_for(missing),
            f"is missing ({len(expected) - len(present)} of the stills {first} to {last} are)",
            "add it, or ask for frames before or after it",
        )


def still_frames(
    pattern: NumberedPattern,
    numbers: list[int],
    max_pixels: int | None,
    read: ReadOptions,
    problems: list[str],
) -> Iterator[tuple[int, VideoSource, VideoFrame]]:
    """Decode stills one after the other: their number, their opened file, their picture.

    Args:
        pattern: The stills' name.
        numbers: The frame numbers to decode.
        max_pixels: Largest picture that is opened [px].
        read: What the user chose.
        problems: Receives one sentence for every still that cannot be decoded and is left out.
    """
    for number in numbers:
        try:
            with VideoSource(pattern.path_for(number), max_pixels, read=read) as source:
                yield number, source, source.first_frame()
            gc.collect(1)  # frames whose side data was read are large and hold themselves
        except MediaError as error:
            problems.append(f"left out: {error}")
