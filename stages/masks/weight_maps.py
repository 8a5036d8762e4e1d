"""A user's weights: a grey picture, or a clip of them, that lies over the source."""

from dataclasses import replace

import numpy as np

from stages.frame import WHITE, Frame
from stages.media import Decoder, FrameRange, open_decoder, probe
from warp_kernels.errors import MediaError, OptionError

GREY_TOLERANCE = 2
"""Most that the channels of a grey pixel differ [code values]: the rounding of other programs."""
NOISE_TOLERANCE = 16
"""The same where the file keeps brightness and colour apart (JPEG, most video), so that
compression gives greys a tint."""
BLACK = 0
"""Grey behind transparent parts of a map: nothing was painted there."""


class WeightMap:
    """Weights of the pixels of a clip, checked as far as can be told before the first frame.

    A white pixel counts fully, a grey one in proportion, and a black one like code value 1, a
    255th: no triangle is without weight. What the frames weigh already is multiplied by them.

    Args:
        path: A still for all frames; numbered stills or a video with a picture for each frame,
            which belongs to the frame of the same number.
        size: Width and height of the source, upright [px].
        frame_range: The frames of the source that are wanted.
        strength: Exponent of the weights.

    Raises:
        MediaError: If the map cannot be read, has another size or is not grey, or if it is a
            still that is black all over.
        OptionError: If a pattern has more than one number field.
    """

    def __init__(
        self,
        path: str,
        size: tuple[int, int],
        frame_range: FrameRange,
        strength: float = 1.0,
    ) -> None:
        self.notes: list[str] = []
        """Choices that were made, one sentence each; complete once it is closed."""
        self.warnings: list[str] = []
        """What may be a mistake, one sentence each; complete once it is closed."""
        greys = np.maximum(np.arange(WHITE + 1), 1)
        self._levels = np.maximum(np.rint(WHITE * (greys / WHITE) ** strength), 1).astype(np.uint8)
        self._path = path
        self._range = replace(frame_range, start_time=None, end_time=None)
        self._decoder: Decoder | None = None
        self._last: int | None = None
        self._lit = False
        self._info = probe(path)
        self._check_size(size)
        self._still = self._read_still() if self._info.kind == "image" else None

    def weighed(self, frame: Frame) -> Frame:
        """Give a frame its weights.

        Args:
            frame: A frame of the source, later than any that was given before.

        Raises:
            MediaError: If there are no weights for it, or they are not grey.
        """
        if self._still is not None:
            return _multiplied(frame, self._still)
        if self._decoder is None:
            # Times of the map mean nothing: a source that is cut by time starts at a known number.
            wanted = replace(self._range, first=frame.index)
            self._decoder = open_decoder(self._path, wanted, paper=BLACK)
        return _multiplied(frame, self._weights_at(frame.index, self._decoder))

    def close(self) -> None:
        """Close the file, and tell what reading it has brought up."""
        decoder, self._decoder = self._decoder, None
        if decoder is None:
            return
        with decoder:
            self._tell(decoder)
        if not self._lit:
            self.warnings.append(f"{self._path}: black in every frame; paint white what counts")

    def _weights_at(self, index: int, decoder: Decoder) -> np.ndarray:
        """Weights of the frame with a number, [H, W] uint8."""
        try:
            found = next(decoder, None)
            while found is not None and found.index < index:  # the source's own one was damaged
                found = next(decoder, None)
        except OptionError:  # the map has no frame in the range
            found = None
        if found is None or found.index != index:
            raise self._missing(index, decoder)
        self._last = index
        grey = self._grey_of(found)
        self._lit = self._lit or bool(grey.any())
        weights: np.ndarray = self._levels[grey]
        return weights

    def _missing(self, index: int, decoder: Decoder) -> MediaError:
        end = "" if self._last is None else f"; the last that it has is for frame {self._last}"
        damage = f" ({decoder.warnings[0]})" if decoder.warnings else ""
        last = "B" if self._last is None else self._last
        return MediaError(
            self._path,
            f"has no weights for frame {index} of the source{end}{damage}",
            f"add them under the same number, choose others with --frames A-{last}, "
            "or give one still for all frames",
        )

    def _read_still(self) -> np.ndarray:
        """The weights of all frames, [H, W] uint8."""
        with open_decoder(self._path, paper=BLACK) as decoder:
            grey = self._grey_of(next(decoder))
            self._tell(decoder)
        if not grey.any():
            raise MediaError(
                self._path, "the weights are black all over", "paint white what counts most"
            )
        weights: np.ndarray = self._levels[grey]
        return weights

    def _grey_of(self, frame: Frame) -> np.ndarray:
        """Grey of a frame of the map, [H, W] uint8."""
        red, green, blue = np.moveaxis(frame.pixels, 2, 0)
        highest = np.maximum(np.maximum(red, green), blue)
        lowest = np.minimum(np.minimum(red, green), blue)
        most = int((highest - lowest).max())
        stored_as_rgb = self._info.color_matrix == "rgb"
        if most > (GREY_TOLERANCE if stored_as_rgb else NOISE_TOLERANCE):
            where = "" if self._info.kind == "image" else f" in frame {frame.index}"
            raise MediaError(
                self._path,
                f"the weights are not grey (channels differ by up to {most}{where})",
                "convert the map to grey",
            )
        return green

    def _check_size(self, size: tuple[int, int]) -> None:
        found = (self._info.width, self._info.height)
        if found != size:
            raise MediaError(
                self._path,
                f"the weights are {found[0]}x{found[1]} and the source is {size[0]}x{size[1]}",
                f"scale the map to {size[0]}x{size[1]}",
            )

    def _tell(self, decoder: Decoder) -> None:
        """Keep what reading the map has brought up beyond what any clip does."""
        new = (note for note in decoder.notes if note not in self._info.notes)
        self.notes += [f"weights: {note}" for note in new]
        self.warnings += [f"weights: {warning}" for warning in decoder.warnings]


def _multiplied(frame: Frame, weights: np.ndarray) -> Frame:
    """A frame whose weights are multiplied by others, white counting once."""
    if frame.weights is not None:
        product = frame.weights.astype(np.uint16) * weights
        weights = np.maximum((product + WHITE // 2) // WHITE, 1).astype(np.uint8)
    return replace(frame, weights=weights)
