"""What every style has in common."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar

from warp_kernels.errors import OptionError
from warp_kernels.styles.color import parse_color

if TYPE_CHECKING:
    import numpy as np

    from warp_kernels.scene.texels import Texels

ReadPicture = Callable[[str], "np.ndarray"]
"""Reads a picture by its name as brightness, 0 (black) to 1 (white), [rows, columns]."""


@dataclass(frozen=True, kw_only=True)
class Style:
    """A look: parameters that the user chooses and a shader that draws.

    The help imports all styles, so their modules are light: shaders are `Imported` when they are
    asked for, and methods import what they need.

    Parameters are fields; their metadata says what they may be, and that is checked here:

        help       what it does
        unit       its unit, if it has one
        range      least and largest value
        choices    the texts that it may be
        form       `color`: written #rgb, #rrggbb or a name of CSS

    Raises:
        OptionError: If a parameter is out of its range.
    """

    opacity: float = field(
        default=1.0, metadata={"help": "how much hides what lies below", "range": (0.0, 1.0)}
    )
    blend: str = field(
        default="normal",
        metadata={
            "help": "how colours meet those below",
            "choices": ("normal", "multiply", "screen", "overlay"),
        },
    )

    shader: ClassVar[Any]
    """A wp.func `(Scene, StyleParameters, Sample, below: vec4f) -> Ink`; `below` is the colour
    [code values] and the opacity of what lies below."""
    prepare: ClassVar[Any] = None
    """A wp.func `(Scene, StyleParameters, triangle) -> Numbers` that fills the style's row of
    `Scene.prepared` before anything is shaded; None if the shader does not look there."""
    degree: ClassVar[int] = 0
    """Least degree of the colour polynomial that the shader needs."""
    covers: ClassVar[bool] = True
    """Whether its ink is opaque everywhere."""
    is_even: ClassVar[bool] = False
    """Whether its ink is the same all over a triangle: the shapes of these are then not needed."""
    needs_source: ClassVar[bool] = False
    """Whether the shader looks at the source picture."""
    lays_strokes: ClassVar[bool] = False
    """Whether the shader looks at `Scene.lay`: where strokes lie that go on from frame to frame."""

    built_from: ClassVar[tuple[str, ...]] = ()
    """Parameters on which its texture depends: what draws it is made anew for other values, where
    all others are numbers that a frame is drawn with."""

    portraits: ClassVar[tuple[str, ...]] = ()
    """Stacks that show it well, such as `paper + circles`, the lowest style first; its name alone
    if there are none."""

    def __post_init__(self) -> None:
        name = type(self).__name__.lower()
        for parameter in fields(self):
            value = getattr(self, parameter.name)
            problem = _problem(value, **parameter.metadata)
            if problem:
                shown = f"{value:g}" if isinstance(value, float) else value
                raise OptionError(f"{name}:{parameter.name}={shown}: {problem}")

    @property
    def is_opaque(self) -> bool:
        """Whether nothing can be transparent where it is drawn."""
        return self.covers and self.opacity == 1.0

    @property
    def hides_below(self) -> bool:
        """Whether nothing of what lies below can be seen."""
        return self.is_opaque and self.blend == "normal"

    @property
    def ground(self) -> str | None:
        """The colour of a sheet that it lays under everything, or None."""
        return None

    def numbers(self) -> tuple[float, ...]:
        """At most sixteen numbers for the shader."""
        return ()

    def texture(self, read: ReadPicture) -> "Texels | None":
        """The texture that its shader looks into, or None.

        Args:
            read: Reads a picture that the user named.

        Raises:
            MediaError: If that picture cannot be read.
        """
        return None


def _problem(
    value: Any,
    *,
    range: tuple[float, float] | None = None,
    choices: tuple[str, ...] | None = None,
    form: str = "",
    unit: str = "",
    help: str = "",
) -> str:
    """What is wrong with a value, or nothing; see `Style` for the rest."""
    if range is not None and not range[0] <= value <= range[1]:
        return f"must lie between {range[0]:g} and {range[1]:g} {unit}".rstrip()
    if choices is not None and value not in choices:
        return f"choose from {', '.join(choices)}"
    if form == "color":
        parse_color(value)
    return ""
