"""Triangles that are drawn with strokes along their base edges: what all such styles share."""

from dataclasses import dataclass, field
from functools import cache
from math import cos, radians, sin
from typing import TYPE_CHECKING, Any, ClassVar

from warp_kernels.errors import OptionError
from warp_kernels.registry import Imported, imported
from warp_kernels.styles.color import parse_color
from warp_kernels.styles.style import ReadPicture, Style

if TYPE_CHECKING:
    from warp_kernels.scene.texels import Texels
    from warp_kernels.styles.tones.tonal_art_map import Drawing

NO_PAPER = "none"
"""Written instead of a colour where what lies below is the paper."""
OWN_PAPER = "triangle"
"""Written instead of a colour where every triangle is a paper of its own colour."""
SHEET = "#f8f4ea"
"""Paper of pencils where none is named."""


@dataclass(frozen=True)
class Drawn(Style):
    """Strokes of a pen or a pencil, denser where the picture is darker.

    Each triangle is a paper of its own colour that the strokes darken, as in the paper's Fig. 1,
    left; or all are one sheet, or there is none and strokes darken what lies below. They lie in the
    plane of the picture, so all of them have one width. In a still they lie along the base edge of
    their triangle; in a clip they then move with the picture, see `Scene.lay`.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5; Praun et al., Real-time
        hatching (2001), Sec. 5: blending between tones.
    Deviation: distances from the base edge are those in the picture, where the paper scales
        barycentric coordinates by its length: strokes of flat triangles keep their width too.
    """

    spacing: float = field(
        default=4.0,
        metadata={
            "help": "distance of neighbouring lines",
            "unit": "px of the source",
            "range": (1.0, 100.0),
        },
    )
    weight: float = field(
        default=0.26,
        metadata={
            "help": "width of the thinnest lines",
            "unit": "of the spacing",
            "range": (0.05, 0.6),
        },
    )
    angle: float = field(
        default=0.0,
        metadata={
            "help": "turn of the lines from the base edge",
            "unit": "degrees",
            "range": (-180.0, 180.0),
        },
    )
    ink: str = field(
        default="#24242c", metadata={"help": "#rgb, #rrggbb or a name", "form": "color"}
    )
    paper: str = field(
        default="triangle",
        metadata={"help": "triangle: each its own colour; a colour: a sheet; none: strokes alone"},
    )
    contrast: float = field(
        default=0.5,
        metadata={
            "help": "how dark strokes are on paper in the triangle's own colour",
            "range": (0.0, 1.0),
        },
    )
    colored: float = field(
        default=0.0,
        metadata={
            "help": "ink (0) or pencils in the colours of the triangles (1)",
            "range": (0, 1),
        },
    )
    lighten: float = field(
        default=0.5,
        metadata={"help": "how much lighter than the picture ink is laid", "range": (0.0, 1.0)},
    )
    grain: float = field(
        default=0.0,
        metadata={"help": "roughness of the paper: pen (0) to soft pencil (1)", "range": (0, 1)},
    )
    seed: int = field(
        default=0, metadata={"help": "chooses one of many drawings", "range": (0, 65535)}
    )

    prepare = Imported("warp_kernels.styles.tones.strokes:prepare_strokes")
    lays_strokes: ClassVar[bool] = True
    built_from: ClassVar[tuple[str, ...]] = ("weight", "grain", "seed")
    drawing: ClassVar[Any]
    """The strokes."""

    def __post_init__(self) -> None:
        super().__post_init__()
        try:
            parse_color(self._sheet)
        except OptionError as error:
            raise OptionError(f"{error}, or {OWN_PAPER}, or {NO_PAPER}") from error

    @property
    def shader(self) -> Any:
        """One of two, by whether there is paper."""
        name = "strokes_alone" if self.paper == NO_PAPER else "strokes_on_paper"
        return imported(f"warp_kernels.styles.tones.strokes:{name}")

    @property
    def covers(self) -> bool:
        """Whether there is paper."""
        return self.paper != NO_PAPER

    @property
    def ground(self) -> str | None:
        """The sheet, if all triangles are one."""
        is_sheet = self.paper not in (NO_PAPER, OWN_PAPER) and self.blend == "normal"
        return self.paper if is_sheet else None

    def numbers(self) -> tuple[float, ...]:
        """In the order of `tones.strokes`."""
        from warp_kernels.styles.tones.tonal_art_map import SPACING

        light = (value**2 for color in (self.ink, self._sheet) for value in parse_color(color))
        turn = radians(self.angle)
        rest = (SPACING / self.spacing, cos(turn), sin(turn), self.lighten, self.colored, self.seed)
        return (*light, *rest, float(self.paper == OWN_PAPER), self.contrast)

    @property
    def _sheet(self) -> str:
        """The colour of a sheet, whether or not it is looked at."""
        return {NO_PAPER: "#fff", OWN_PAPER: SHEET}.get(self.paper, self.paper)

    def texture(self, read: ReadPicture) -> "Texels":
        """The tonal art map."""
        return _texture_of(type(self).drawing, self.weight, self.grain, self.seed)


@cache
def _texture_of(drawing: "Drawing", weight: float, grain: float, seed: int) -> "Texels":
    from warp_kernels.styles.tones.lookup import packed_tones
    from warp_kernels.styles.tones.tonal_art_map import tonal_art_map

    return packed_tones(tonal_art_map(drawing, width=weight, grain=grain, seed=seed))
