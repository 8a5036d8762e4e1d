"""Files that are too large to be opened, in pixels and in streams."""

from pathlib import Path

from warp_kernels.errors import MediaError


def check_size(path: Path, width: int, height: int, max_pixels: int) -> None:
    """Refuse pictures that are too large, before memory is taken for them.

    Args:
        path: The file, for the message.
        width: Declared width [px]; 0 if unknown.
        height: Declared height [px]; 0 if unknown.
        max_pixels: The limit [px].

    Raises:
        MediaError: If the picture exceeds the limit.
    """
    if width * height > max_pixels:
        raise MediaError(
            path,
            f"{width}x{height} is {width * height / 1e6:.0f} million pixels, "
            f"more than {max_pixels / 1e6:.0f} million",
            "scale it down with another program first, or raise --limits pixels=N for a source",
        )


def check_streams(path: Path, count: int, most: int) -> None:
    """Refuse files of too many streams.

    Args:
        path: The file, for the message.
        count: How many it has.
        most: The limit.

    Raises:
        MediaError: If it has more.
    """
    if count > most:
        raise MediaError(path, f"has more than {most} streams", "raise --limits streams=N")
