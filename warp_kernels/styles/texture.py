"""A picture in every triangle, which makes it brighter and darker."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from warp_kernels.errors import OptionError, TrimotionError
from warp_kernels.registry import Imported
from warp_kernels.styles.style import ReadPicture, Style

if TYPE_CHECKING:
    from warp_kernels.scene.texels import Texels

HOLDS_IT = "data:"
"""How a text begins that holds the picture itself: it is not told whole."""


@dataclass(frozen=True)
class Texture(Style):
    """A texture that modulates brightness: of what lies below, or of the triangle's colour.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5, Fig. 6.
    Deviation: a middle grey leaves colours alone and a lighter one brightens them.
    """

    file: str = field(
        default="cushion",
        metadata={"help": "cushion, triangle, or a picture whose lower edge is the base edge"},
    )
    strength: float = field(
        default=1.0, metadata={"help": "contrast of the picture", "range": (0.0, 4.0)}
    )

    shader = Imported("warp_kernels.styles.shaders.texture:textured_color")
    prepare = Imported("warp_kernels.styles.shaders.texture:prepare_texture")
    built_from: ClassVar[tuple[str, ...]] = ("file",)
    portraits: ClassVar[tuple[str, ...]] = ("texture:cushion", "texture:triangle")

    @property
    def hides_below(self) -> bool:
        """Never: it is what lies below that it makes brighter and darker."""
        return False

    def numbers(self) -> tuple[float, ...]:
        """Strength."""
        return (self.strength,)

    def texture(self, read: ReadPicture) -> "Texels | None":
        """The picture that was asked for."""
        from warp_kernels.scene.texels import Texels
        from warp_kernels.styles.pictures import PICTURES

        if self.file in PICTURES:
            return Texels.of(PICTURES[self.file]()[None]).with_neighbours(repeats=False)
        try:
            return Texels.of(read(self.file)[None]).with_neighbours(repeats=False)
        except TrimotionError as error:
            known = ", ".join(PICTURES)
            name = f"{HOLDS_IT}..." if self.file.startswith(HOLDS_IT) else self.file
            told = str(error).removeprefix(f"{self.file}: ")
            raise OptionError(f"texture:{name}: {told}, or choose from {known}") from error
