"""What every style has in common."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from warp_kernels.styles.parameters import check_parameters

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

    Parameters are fields; their metadata say what they may be, see `parameters`.

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

    stays: ClassVar[bool] = False
    """Whether it stays where it is while triangles move."""

    built_from: ClassVar[tuple[str, ...]] = ()
    """Parameters on which its texture depends: what draws it is made anew for other values, where
    all others are numbers that a frame is drawn with."""

    portraits: ClassVar[tuple[str, ...]] = ()
    """Stacks that show it well, such as `paper + circles`, the lowest style first; its name alone
    if there are none."""

    def __post_init__(self) -> None:
        check_parameters(self)

    @property
    def is_opaque(self) -> bool:
        """Whether nothing can be transparent where it is drawn."""
        return self.covers and self.opacity == 1.0

    @property
    def hides_below(self) -> bool:
        """Whether nothing of what lies below can be seen."""
        return self.is_opaque and self.blend == "normal"

    @property
    def is_sheet(self) -> bool:
        """Whether it lies under everything else, and stays there while triangles move over it."""
        return False

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
