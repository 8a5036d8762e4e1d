"""How many frames a source has, without decoding them."""

from pathlib import Path

from stages.media.naming import input_pattern
from stages.media.reading.container import DAMAGE
from stages.media.reading.read_options import AS_IT_COMES, ReadOptions
from stages.media.reading.sequence import existing_numbers
from stages.media.reading.source import VideoSource
from warp_kernels.device.memory import refuse_if_short


def count_frames(path: str | Path, read: ReadOptions = AS_IT_COMES) -> int:
    """One more than the highest frame number that there can be.

    Args:
        path: A video, a still or a pattern of numbered stills, whose frames go by their numbers.
        read: What the user chose.

    Raises:
        MediaError: If it cannot be read.
    """
    pattern = input_pattern(path)
    if pattern is not None:
        return existing_numbers(pattern)[-1] + 1
    with VideoSource(Path(path), read=read) as source:
        count = 0
        try:
            for packet in source.container.demux(source.stream):
                count += packet.size > 0 and not packet.is_discard
        except DAMAGE as error:
            refuse_if_short(error)  # else it breaks off here, as it does when it is decoded
        return count
