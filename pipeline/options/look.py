"""What decides a picture, once there is a mesh: styles, regions, size, smoothness over time."""

from dataclasses import dataclass, field

from stages.masks.region import Region
from warp_kernels.energy.color_model import CONSTANT, LINEAR, ColorModel
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SIDE
from warp_kernels.styles import STYLES, Style

MAX_BLEND = 250
"""Frames; ten seconds. What fades must be kept in memory."""
MAX_SMOOTH = 50
"""Frames; three times as many on either side are kept in memory."""


@dataclass(frozen=True)
class Look:
    """How meshes are drawn.

    Raises:
        OptionError: If an option has an impossible value.
    """

    styles: tuple[Style, ...] = field(
        default=(),
        metadata={
            "help": "look of the triangles, repeatable from bottom to top "
            "(default: flat, or gradient with --color linear)",
            "registry": STYLES,
            "flag": "style",
        },
    )
    """Looks, bottom to top; empty for the one that suits the colour model."""
    regions: tuple[Region, ...] = field(
        default=(),
        metadata={
            "help": "a style inside of a mask, over the others, repeatable: a still, numbered "
            "stills or a video of the source's size, white where the style is drawn; "
            "MASK@FRAME,FRAME,...:STYLE follows what it shows in these frames through their shots",
            "metavar": "MASK[@FRAME]:STYLE",
            "flag": "region",
        },
    )
    """Styles inside of masks, over `styles`, bottom to top."""
    output_size: tuple[int, int] | None = field(
        default=None,
        metadata={
            "help": "size of the output (default: the source's)",
            "metavar": "WxH",
            "flag": "size",
        },
    )
    """Width and height of the output [px], or None."""
    scale: float | None = field(
        default=None, metadata={"help": "size of the output relative to the source"}
    )
    """Size of the output relative to the source, or None."""
    blend: int = field(
        default=0,
        metadata={
            "help": "frames over which triangles fade in where they replace others, 0 for at once"
        },
    )
    """Most frames over which new triangles fade in."""
    smooth: float = field(
        default=0.0,
        metadata={
            "help": "smooth paths and colours over time: standard deviation in frames, 0 for not"
        },
    )
    """Standard deviation of the smoothing over time [frames]."""

    def __post_init__(self) -> None:
        if self.output_size is not None and self.scale is not None:
            raise OptionError("--size and --scale exclude each other; give one of them")
        if self.output_size is not None:
            check_output_size(self.output_size, "--size {}x{}".format(*self.output_size))
        if self.scale is not None and not 0 < self.scale <= MAX_SIDE:
            raise OptionError(
                f"--scale {self.scale:g}: must be above 0 and at most {MAX_SIDE}; try 2"
            )
        if not 0 <= self.blend <= MAX_BLEND:
            raise OptionError(f"--blend {self.blend}: must lie between 0 (off) and {MAX_BLEND}")
        if not 0 <= self.smooth <= MAX_SMOOTH:
            raise OptionError(
                f"--smooth {self.smooth:g}: must lie between 0 (off) and {MAX_SMOOTH}"
            )

    def shown_styles(self, model: ColorModel) -> tuple[Style, ...]:
        """Looks, bottom to top; the one that shows the optimised colours if none is chosen.

        Args:
            model: The colour model that is optimised.
        """
        return self.styles or (STYLES["gradient" if model.degree > 0 else "flat"](),)

    def fitted(self, model: ColorModel) -> ColorModel:
        """The colour model of the snapshots: the optimised one, or what a look needs beyond.

        Args:
            model: The colour model that is optimised.
        """
        shown = (*self.shown_styles(model), *self._in_regions)
        drawn = LINEAR if any(style.degree > 0 for style in shown) else CONSTANT
        return max(model, drawn, key=lambda model: model.degree)

    @property
    def lays_strokes(self) -> bool:
        """Whether a look has strokes that go on from frame to frame: all of a shot is needed."""
        return any(style.lays_strokes for style in (*self.styles, *self._in_regions))

    @property
    def needs_source(self) -> bool:
        """Whether a look shows the source picture."""
        return any(style.needs_source for style in (*self.styles, *self._in_regions))

    @property
    def followed(self) -> tuple[Region, ...]:
        """Regions that stay with their triangles."""
        return tuple(region for region in self.regions if region.frames)

    @property
    def unfollowed(self) -> tuple[Region, ...]:
        """Regions whose masks say for every frame where they are."""
        return tuple(region for region in self.regions if not region.frames)

    @property
    def _in_regions(self) -> tuple[Style, ...]:
        return tuple(region.style for region in self.regions)

    def size_for(self, source_size: tuple[int, int]) -> tuple[int, int]:
        """Size of the output for a source.

        Args:
            source_size: Width and height of the source, upright [px].

        Returns:
            Width and height [px].

        Raises:
            OptionError: If a scaled source has no pixel or too many.
        """
        if self.output_size is not None:
            return self.output_size
        if self.scale is None:
            return source_size
        width, height = (round(side * self.scale) for side in source_size)
        what = f"--scale {self.scale:g} makes {width}x{height} of {source_size[0]}x{source_size[1]}"
        check_output_size((width, height), what)
        return width, height


def check_output_size(size: tuple[int, int], what: str) -> None:
    """Refuse sizes that no output can have.

    Args:
        size: Width and height [px].
        what: The option, for the message.

    Raises:
        OptionError: If a side is below 1 or beyond `MAX_SIDE`.
    """
    if not 1 <= min(size) <= max(size) <= MAX_SIDE:
        raise OptionError(f"{what}: sides must lie between 1 and {MAX_SIDE} pixels")
