"""What decides a picture, once there is a mesh: styles, regions, size, smoothness over time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from pipeline.options.hearing import Hearing
from stages.look.framing import Framing, framing_of
from stages.masks.region import Region
from stages.moves import MOVES, Move
from stages.toning.grade import Grade
from stages.toning.palette import Palette
from warp_kernels.color_model import CONSTANT, LINEAR, ColorModel
from warp_kernels.errors import OptionError
from warp_kernels.limits import MAX_SAMPLES, MAX_SIDE, SAMPLES
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.color import parse_color

if TYPE_CHECKING:
    from stages.toning.tone import Tone

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
            "metavar": "SPEC",
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
    moves: tuple[Move, ...] = field(
        default=(),
        metadata={
            "help": "how triangles move while they are drawn, repeatable, one after the other",
            "registry": MOVES,
            "metavar": "SPEC",
            "flag": "move",
        },
    )
    """How triangles move, the first one first."""
    palette: Palette | None = field(
        default=None,
        metadata={
            "help": "colours that those of the triangles become: #123,#fa0,white from dark to "
            "bright, a file (.txt, .json, .gpl, .ase, .aco), a picture, or sepia, blueprint, "
            "sunset, forest, ice, riso, noir; then :mode=nearest, amount=, hold=, count=",
            "metavar": "FILE|COLORS",
        },
    )
    """The colours that those of triangles become, or None."""
    grade: Grade | None = field(
        default=None,
        metadata={
            "help": "change the colours of the triangles: exposure, contrast, saturation, hue, "
            "such as exposure=0.5,saturation=0.8",
            "metavar": "KEY=VALUE",
        },
    )
    """How colours of triangles are changed, before the palette; None for not."""
    output_size: tuple[int, int] | None = field(
        default=None,
        metadata={
            "help": "size of the output: WxH, 1080x or x1080 for the source's shape, or square, "
            "portrait, story, 720p, 1080p, 1440p, 4k (default: the source's)",
            "metavar": "WxH",
            "flag": "size",
        },
    )
    """Width and height of the output [px], 0 for one that follows from the other; or None."""
    fit: str = field(
        default="contain",
        metadata={
            "help": "how the picture gets into a --size of another shape: contain shows all of it "
            "with bars, cover fills and cuts off, stretch fills with pixels that are no squares",
            "choices": ("contain", "cover", "stretch"),
        },
    )
    """`contain`, `cover` or `stretch`."""
    background: str | None = field(
        default=None,
        metadata={
            "help": "colour of bars, and of what transparent styles leave open: #rgb, #rrggbb or a "
            "name (default: bars as the paper among the styles, or black)",
            "metavar": "COLOR",
        },
    )
    """A colour, or None for that of the lowest style's paper."""
    scale: float | None = field(
        default=None, metadata={"help": "size of the output relative to the source"}
    )
    """Size of the output relative to the source, or None."""
    samples: int = field(
        default=SAMPLES,
        metadata={
            "help": "samples of a pixel, across and down each: 4 makes borders smoother, 1 leaves "
            "them jagged"
        },
    )
    """Samples of an output pixel, across and down each."""
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

    timeline: str | None = field(
        default=None,
        metadata={
            "help": "what changes over time: a file of sections and curves, or a shipped one: "
            "pulse, build-up, ink-to-colour, strobe-safe",
            "metavar": "FILE.toml|NAME",
            "group": "time",
            "is_single": True,
        },
    )
    """A file with what changes over time, or the name of a shipped one."""
    hearing: Hearing = field(default_factory=Hearing)
    """What the file hears."""
    sections: tuple["Look", ...] = ()
    """Looks that the file gives to parts of the film, in place of this one."""
    score: Any = None
    """What was read of the file, a `pipeline.timeline.timeline.Timeline`."""

    def __post_init__(self) -> None:
        if self.output_size is not None and self.scale is not None:
            raise OptionError("--size and --scale exclude each other; give one of them")
        if self.output_size is not None:
            width, height = self.output_size
            sides = (width or height, height or width)
            check_output_size(sides, f"--size {width or ''}x{height or ''}")
        if self.fit not in ("contain", "cover", "stretch"):
            raise OptionError(f"--fit {self.fit}: choose from contain, cover, stretch")
        if self.background is not None:
            _read_color(self.background)
        if self.scale is not None and not 0 < self.scale <= MAX_SIDE:
            raise OptionError(
                f"--scale {self.scale:g}: must be above 0 and at most {MAX_SIDE}; try 2"
            )
        if not 1 <= self.samples <= MAX_SAMPLES:
            raise OptionError(
                f"--samples {self.samples}: must lie between 1 and {MAX_SAMPLES}, across and down"
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
        shown = (*self.shown_styles(model), *self._everywhere)
        drawn = LINEAR if any(style.degree > 0 for style in shown) else CONSTANT
        return max(model, drawn, key=lambda model: model.degree)

    @property
    def lays_strokes(self) -> bool:
        """Whether a look has strokes that go on from frame to frame: all of a shot is needed."""
        return any(style.lays_strokes for style in self._everywhere)

    @property
    def toned(self) -> Mapping[str, Any]:
        """What changes the colours of triangles, by the names that curves have for it."""
        return {"grade": self.grade or Grade(), "palette": self.palette}

    @property
    def tone(self) -> "Tone":
        """What is done to the colours of triangles."""
        from stages.toning.tone import Tone

        return Tone(self.grade or Grade(), self.palette)

    @property
    def holds_colors(self) -> bool:
        """Whether triangles keep a palette's colours from frame to frame: all of a shot is needed.

        A curve may make any palette one of that kind.
        """
        palettes = [one.palette for one in (self, *self.sections) if one.palette is not None]
        return any(palette.is_nearest or self.score is not None for palette in palettes)

    @property
    def needs_source(self) -> bool:
        """Whether a look shows the source picture."""
        return any(style.needs_source for style in self._everywhere)

    @property
    def followed(self) -> tuple[Region, ...]:
        """Regions that stay with their triangles, those of sections among them."""
        return tuple(region for region in self.all_regions if region.frames)

    @property
    def unfollowed(self) -> tuple[Region, ...]:
        """Regions whose masks say for every frame where they are, those of sections among them."""
        return tuple(region for region in self.all_regions if not region.frames)

    @property
    def all_regions(self) -> tuple[Region, ...]:
        """The regions of this look, then those that sections add."""
        found = [*self.regions, *(r for one in self.sections for r in one.regions)]
        return tuple(dict.fromkeys(found))

    @property
    def _everywhere(self) -> tuple[Style, ...]:
        """All styles that are drawn at any time."""
        own = (*self.styles, *(region.style for region in self.regions))
        return (*own, *(style for one in self.sections for style in one._everywhere))

    def backdrop(self, model: ColorModel) -> tuple[float, float, float] | None:
        """What is seen where there is no picture [code values]; None where nothing is.

        Args:
            model: The colour model that is optimised.
        """
        if self.background is not None:
            return _read_color(self.background)
        for style in reversed(self.shown_styles(model)):
            if style.is_opaque:
                return None if style.ground is None else parse_color(style.ground)
        return None

    @property
    def hidden(self) -> list[str]:
        """What is told of styles that cannot be seen, one sentence each."""
        names = [type(style).__name__.lower() for style in self.styles]
        for place in range(len(names) - 1, 0, -1):
            if self.styles[place].hides_below:
                below = ", ".join(dict.fromkeys(names[:place]))
                remedy = "styles are laid from bottom to top"
                if hasattr(self.styles[place], "paper"):
                    remedy = f"{names[place]}:paper=none lets it through"
                return [f"--style {names[place]} hides {below} below it; {remedy}"]
        return []

    def framing_for(self, source: tuple[int, int], sample_aspect: Fraction) -> Framing:
        """Where the picture lies on the output.

        Args:
            source: Width and height of the source, upright [px].
            sample_aspect: Width of its pixels over their height.

        Raises:
            OptionError: If the output has no pixel or too many.
        """
        if self.scale is None:
            return framing_of(source, sample_aspect, self.output_size, self.fit)
        width, height = (round(side * self.scale) for side in source)
        what = f"--scale {self.scale:g} makes {width}x{height} of {source[0]}x{source[1]}"
        check_output_size((width, height), what)
        return Framing((width, height), (width, height), None)


def _read_color(text: str) -> tuple[float, float, float]:
    try:
        return parse_color(text)
    except OptionError as error:
        raise OptionError(f"--background {text}: {error}") from error


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
