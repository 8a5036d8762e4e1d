"""A palette: the few colours that all colours of triangles become."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    import numpy as np

Color = tuple[float, float, float]
"""Red, green and blue [code values]."""
MOST_COLORS = 1024
"""More are no palette."""
MODES = ("map", "match", "nearest")
"""How colours find theirs."""

PALETTES: dict[str, tuple[str, ...]] = {
    "sepia": ("#1d120b", "#6d4a30", "#c39a6b", "#f7ead2"),
    "blueprint": ("#0b2a5b", "#1d5fa8", "#7fb4e6", "#f2f8ff"),
    "sunset": ("#1b1035", "#5b2a6e", "#c9436a", "#f58549", "#ffd97d", "#fff6d9"),
    "forest": ("#0b1f1a", "#1f4d3a", "#5d8a4a", "#b5c269", "#f4efc9"),
    "ice": ("#071a2b", "#1f4e6e", "#4f9db5", "#a9dbe0", "#f4fdff"),
    "riso": ("#1b2a6b", "#ff4f79", "#ffd23f", "#f7f3e8"),
    "noir": ("#050505", "#3a3a3a", "#9a9a9a", "#f2f2f2"),
}
"""Palettes that are known by their names, from dark to bright."""


@dataclass(frozen=True)
class Palette:
    """The colours, and how others become these.

    Raises:
        OptionError: If there are too few colours, or too many, or a number is out of its range.
    """

    colors: tuple[Color, ...] = field(metadata={"is_built": True})
    """The colours, in order."""
    mode: str = field(
        default="map",
        metadata={
            "help": "map lays the colours evenly along brightness, the first for black; match "
            "where they are as bright themselves; nearest takes the one that looks most alike",
            "choices": MODES,
        },
    )
    """One of `MODES`."""
    amount: float = field(
        default=1.0, metadata={"help": "how much of it, 0 for nothing", "range": (0.0, 1.0)}
    )
    """How much of it; between, colours are mixed in Oklab."""
    hold: float = field(
        default=0.03,
        metadata={
            "help": "nearest: a triangle keeps its colour until another is nearer by this, "
            "1 being the way from black to white",
            "range": (0.0, 1.0),
        },
    )
    """How much nearer another colour must be before a triangle changes to it [of Oklab]."""

    def __post_init__(self) -> None:
        if not 2 <= len(self.colors) <= MOST_COLORS:
            raise OptionError(
                f"a palette of {len(self.colors)}: it needs two colours or more, at most "
                f"{MOST_COLORS}"
            )
        if self.mode not in MODES:
            raise OptionError(f"mode={self.mode}: choose from {', '.join(MODES)}")
        for name in ("amount", "hold"):
            value = getattr(self, name)
            if not 0.0 <= value <= 1.0:
                raise OptionError(f"{name}={value:g}: must lie between 0 and 1")

    @property
    def is_nearest(self) -> bool:
        """Whether every triangle becomes one of the colours."""
        return self.mode == "nearest"

    @property
    def lab(self) -> "np.ndarray":
        """The colours as L, a, b, see `oklab_colors`, [N, 3]."""
        import numpy as np

        from stages.toning.oklab_colors import to_lab

        return to_lab(np.array(self.colors))

    def nearest(self, lab: "np.ndarray") -> "np.ndarray":
        """Numbers of the colours that look most alike, the first of equal ones.

        Args:
            lab: Colours, [N, 3].
        """
        import numpy as np

        best = np.zeros(len(lab), dtype=np.int64)
        least = np.full(len(lab), np.inf)
        for number, color in enumerate(self.lab):  # a few: N at once would be N times as much
            away = ((lab - color) ** 2).sum(axis=1)
            nearer = away < least
            best[nearer], least[nearer] = number, away[nearer]
        return best

    def applied(self, lab: "np.ndarray", numbers: "np.ndarray | None") -> "np.ndarray":
        """Change colours.

        Args:
            lab: L, a and b, see `oklab_colors`, [N, 3].
            numbers: Which of the colours each becomes, [N]; None for where its brightness lies.

        Returns:
            The same form.
        """
        import numpy as np

        own = self.lab
        if numbers is not None:
            found = own[numbers]
        else:
            stops = np.linspace(0.0, 1.0, len(own))
            if self.mode == "match":
                own = own[np.argsort(own[:, 0], kind="stable")]
                stops = own[:, 0]
            found = np.stack([np.interp(lab[:, 0], stops, own[:, k]) for k in range(3)], axis=1)
        if self.amount == 1.0:
            return found
        return lab + self.amount * (found - lab)
