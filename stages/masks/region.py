"""A style inside of a mask."""

from dataclasses import dataclass, field

from warp_kernels.styles import STYLES, Style


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
