"""Where the picture lies on an output of another shape."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Framing:
    """A picture on its canvas."""

    canvas: tuple[int, int]
    """Width and height of the output [px]."""
    picture: tuple[int, int]
    """Width and height at which the whole picture is drawn [px]."""
    sample_aspect: Fraction | None
    """Width of the output's pixels over their height; None if it follows from the two sizes."""

    @property
    def is_plain(self) -> bool:
        """Whether the picture is the output."""
        return self.canvas == self.picture

    @property
    def offset(self) -> tuple[int, int]:
        """Columns and rows left of and above the picture [px]; below 0 where it is cut off."""
        across, down = (out - side for out, side in zip(self.canvas, self.picture, strict=True))
        return across // 2, down // 2


def framing_of(
    source: tuple[int, int], sample_aspect: Fraction, size: tuple[int, int] | None, fit: str
) -> Framing:
    """Decide where a picture lies.

    Pixels of an output of a given size are squares, but for `stretch`. Shapes that differ by less
    than a pixel are the same.

    Args:
        source: Width and height of the source, upright [px].
        sample_aspect: Width of its pixels over their height.
        size: Width and height of the output [px], 0 for one that follows from the other; None for
            the source's size, whose pixels stay as they are.
        fit: `contain` shows the whole picture, with bars; `cover` fills the output and cuts off;
            `stretch` fills it with pixels that are no squares, by which players give the picture
            its shape back.

    Raises:
        OptionError: If the picture would be too large or have no pixel.
    """
    if size is None:
        return Framing(source, source, None)
    shape = Fraction(source[0]) * sample_aspect / source[1]
    if 0 in size:
        canvas = _completed(size, shape)
        return Framing(canvas, canvas, Fraction(1))
    width, height = canvas = size
    if fit == "stretch":
        return Framing(canvas, canvas, None)
    by_width, by_height = (width, round(width / shape)), (round(height * shape), height)
    fills = Fraction(width, height) > shape
    picture = by_width if fills == (fit == "cover") else by_height
    if max(abs(side - out) for side, out in zip(picture, canvas, strict=True)) <= 1:
        picture = canvas
    _check(picture, f"--size {width}x{height} --fit {fit}")
    return Framing(canvas, picture, Fraction(1))


def framed(
    pixels: "np.ndarray", framing: Framing, background: tuple[float, float, float] | None
) -> "np.ndarray":
    """Put a picture on its canvas.

    Args:
        pixels: Code values, [rows, columns, 3 or 4] uint8, of the size of `framing.picture`.
        framing: Where it lies.
        background: What is seen beside it, and through it [code values]; None for nothing, which
            is black if the picture has no alpha.

    Returns:
        Code values, [rows, columns, 3] uint8, or 4 channels if something is transparent.
    """
    import numpy as np

    if background is not None and pixels.shape[2] == 4:
        pixels = _over(pixels, background)
    if framing.is_plain:
        return pixels
    width, height = framing.canvas
    across, down = framing.offset
    left, top = max(0, -across), max(0, -down)
    cut = pixels[top : top + height, left : left + width]
    canvas = np.zeros((height, width, pixels.shape[2]), dtype=np.uint8)
    if background is not None:
        canvas[:] = np.rint(background)
    left, top = max(0, across), max(0, down)
    canvas[top : top + cut.shape[0], left : left + cut.shape[1]] = cut
    return canvas


def _over(rgba: "np.ndarray", background: tuple[float, float, float]) -> "np.ndarray":
    """A picture over one colour, [H, W, 3] uint8."""
    import numpy as np

    alpha = rgba[..., 3:].astype(np.uint32)
    mixed = rgba[..., :3] * alpha + np.rint(background).astype(np.uint32) * (255 - alpha)
    return ((mixed + 127) // 255).astype(np.uint8)


def _completed(size: tuple[int, int], shape: Fraction) -> tuple[int, int]:
    """A size with the side that follows from the other one.

    It is even if the given one is: most videos need that, and nobody sees the difference.
    """
    width, height = size
    given = width or height
    exact = given / shape if width else given * shape
    other = 2 * round(exact / 2) if given % 2 == 0 else round(exact)
    found = (given, other) if width else (other, given)
    _check(found, f"--size {width or ''}x{height or ''}")
    return found


def _check(picture: tuple[int, int], what: str) -> None:
    if not 1 <= min(picture) <= max(picture) <= MAX_SIDE:
        raise OptionError(
            f"{what}: the picture would be {picture[0]}x{picture[1]}; sides must lie between 1 and "
            f"{MAX_SIDE} pixels"
        )
