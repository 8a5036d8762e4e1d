"""Styles inside of masks."""

from collections.abc import Sequence

import numpy as np

from stages.frame import Frame
from stages.masks.gray import gray_of
from stages.masks.region import Region
from stages.media import Decoder, FrameRange, input_pattern, open_decoder, probe
from warp_kernels.errors import MediaError, OptionError

BLACK = 0
"""Grey behind transparent parts of a mask: nothing was painted there."""


class Mask:
    """The mask of a region, frame by frame.

    Args:
        path: A still for all frames, or a clip with a picture for each, by the frames' numbers.
        size: Width and height of the source, upright [px].
        is_single: Whether one frame alone is asked for: others may be missing then.

    Raises:
        MediaError: If it cannot be read or has another size.
    """

    def __init__(self, path: str, size: tuple[int, int], *, is_single: bool = False) -> None:
        self._path = path
        self._is_single = is_single
        info = probe(path)
        if (info.width, info.height) != size:
            raise MediaError(
                path,
                f"the mask is {info.width}x{info.height} and the source {size[0]}x{size[1]}",
                f"scale it to {size[0]}x{size[1]}",
            )
        self._is_still = info.kind == "image"
        self._decoder: Decoder | None = None
        self._last: tuple[int, np.ndarray] | None = None

    def at(self, index: int) -> np.ndarray:
        """The mask of a frame.

        Args:
            index: Its number in the source; no smaller than any asked for before.

        Returns:
            White where the style is drawn, [H, W] uint8.

        Raises:
            MediaError: If there is none for the frame, or it cannot be read.
        """
        if self._last is not None and (self._is_still or self._last[0] == index):
            return self._last[1]
        first = 0 if self._is_still else index
        found = self._found(first)
        if found is None or found.index != first:
            raise MediaError(
                self._path,
                f"has no mask for frame {index} of the source",
                "add it under the same number, or give one still for all frames",
            )
        gray = np.rint(255.0 * gray_of(found.pixels)).astype(np.uint8)
        self._last = (index, gray)
        return gray

    def _found(self, first: int) -> Frame | None:
        """The first picture with this number or a higher one, or None if it is not there."""
        pattern = input_pattern(self._path)
        if self._is_single and pattern is not None and first not in pattern.numbers():
            return None
        try:
            if self._decoder is None:
                wanted = FrameRange(first, first if self._is_single else None)
                self._decoder = open_decoder(self._path, wanted, paper=BLACK)
            return next((frame for frame in self._decoder if frame.index >= first), None)
        except OptionError:  # it speaks of the frames of a source
            return None

    def close(self) -> None:
        """Close the file."""
        if self._decoder is not None:
            self._decoder.close()


def open_masks(regions: Sequence[Region], size: tuple[int, int]) -> list[Mask]:
    """Open the masks of regions.

    Args:
        regions: What is drawn where.
        size: Width and height of the source, upright [px].

    Raises:
        MediaError: If a mask cannot be read or has another size.
    """
    return [Mask(region.mask, size) for region in regions]
