"""A style inside of a mask."""

import os
import re
from dataclasses import dataclass, field

from stages.masks.area import Area
from stages.media.naming import input_pattern
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES, Style

_FRAMES = re.compile(r"[0-9]+(,[0-9]+)*")


@dataclass(frozen=True)
class Region:
    """A style and where it is drawn."""

    mask: str
    """A still, a video or numbered stills of the source's size: white where the style is."""
    style: Style = field(metadata={"registry": STYLES})
    """The style."""
    frames: tuple[int, ...] = ()
    """Numbers of the frames for which the mask was drawn, ascending: the triangles that it shows
    there carry the style through their shot. Empty if the mask does not follow them."""
    areas: tuple[Area, ...] = ()
    """What a person pointed at in the one frame of the region, if `mask` names no file."""

    @classmethod
    def of(cls, text: str, style: Style, flag: str) -> "Region":
        """A region from what a user wrote.

        Args:
            text: `MASK`, or `MASK@FRAME,FRAME,...` unless the whole is the name of a file.
            style: The style.
            flag: The option, for messages.

        Raises:
            OptionError: If what follows @ are no frames.
        """
        mask, _, frames = text.rpartition("@")
        if not mask or _is_there(text):
            return cls(text, style)
        if _FRAMES.fullmatch(frames):
            return cls(mask, style, tuple(sorted({int(frame) for frame in frames.split(",")})))
        if _is_there(mask):
            raise OptionError(
                f"{flag} {text}: {frames!r} are no frames; after @ stand their numbers, such as "
                "MASK@57 or MASK@57,120"
            )
        return cls(text, style)


def _is_there(name: str) -> bool:
    """Whether a name is that of a file or of numbered stills."""
    pattern = input_pattern(name)
    return os.path.exists(name) if pattern is None else bool(pattern.numbers())
