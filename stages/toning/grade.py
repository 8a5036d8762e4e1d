"""A grade: exposure, contrast, saturation and hue of all colours of triangles."""

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

MIDDLE_GREY = 0.5
"""Lightness that a change of contrast leaves as it is."""


@dataclass(frozen=True)
class Grade:
    """How colours are changed, in this order; as it stands it changes nothing.

    Raises:
        OptionError: If a number is out of its range.
    """

    exposure: float = field(
        default=0.0,
        metadata={"help": "brighter or darker: 1 is twice the light", "range": (-8.0, 8.0)},
    )
    contrast: float = field(
        default=1.0,
        metadata={"help": "factor of the distance from middle grey", "range": (0.0, 4.0)},
    )
    saturation: float = field(
        default=1.0, metadata={"help": "factor of colourfulness, 0 for grey", "range": (0.0, 4.0)}
    )
    hue: float = field(
        default=0.0,
        metadata={
            "help": "turn of all hues, 120 from red towards green",
            "unit": "degrees",
            "range": (-3600.0, 3600.0),
        },
    )

    def __post_init__(self) -> None:
        for parameter in fields(self):
            least, most = parameter.metadata["range"]
            value = getattr(self, parameter.name)
            if not least <= value <= most:
                raise OptionError(
                    f"{parameter.name}={value:g}: must lie between {least:g} and {most:g}"
                )

    @property
    def is_plain(self) -> bool:
        """Whether it changes nothing."""
        turns = self.hue % 360.0
        return (self.exposure, self.contrast, self.saturation, turns) == (0.0, 1.0, 1.0, 0.0)

    def applied(self, lab: "np.ndarray") -> "np.ndarray":
        """Change colours.

        Args:
            lab: L, a and b, see `oklab_colors`, [..., 3].

        Returns:
            The same form; beyond what screens show colours are cut off when they are drawn.
        """
        import numpy as np

        lab = lab * 2.0 ** (self.exposure / 3.0)  # Oklab is in cube roots of light
        light = MIDDLE_GREY + self.contrast * (lab[..., 0] - MIDDLE_GREY)
        angle = np.deg2rad(self.hue % 360.0)
        cosine, sine = self.saturation * np.cos(angle), self.saturation * np.sin(angle)
        a, b = lab[..., 1], lab[..., 2]
        return np.stack([light, cosine * a - sine * b, sine * a + cosine * b], axis=-1)
