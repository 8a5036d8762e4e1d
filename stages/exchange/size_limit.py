"""Outputs that would be larger than their format or anyone's memory holds."""

from stages.exchange.film import Film
from warp_kernels.errors import OptionError


def refuse_size(film: Film, triangles: int, frame_bytes: int, most: int) -> None:
    """Refuse a file that would be too large, at its first frame.

    Args:
        film: Tells how many frames a file holds.
        triangles: Those of a frame.
        frame_bytes: What a frame of as many takes.
        most: What a file may have [bytes].

    Raises:
        OptionError: If it would.
    """
    size = (film.frames or 1) * frame_bytes
    if size > most:
        raise OptionError(
            f"{film.ending}: {film.frames or 1} frames of {triangles} triangles would be "
            f"{size / 2**30:.1f} GiB, and a file holds {most / 2**30:.1f}; use fewer --frames or "
            f"--triangles, or numbered files such as name_####{film.ending}"
        )
