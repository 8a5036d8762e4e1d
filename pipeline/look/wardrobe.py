"""One renderer for every kind of stack that a film is drawn with."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.options.look import Look
from stages.look.fading import Fading
from stages.look.veil import Curtain
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.toning.choices import Choices
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.drawing.canvas import coats_of
from warp_kernels.drawing.shade import channels_of
from warp_kernels.drawing.stack_kind import kind_of_stack
from warp_kernels.scene.stroke_lay import Lay


@dataclass(frozen=True, eq=False)
class Posed:
    """A frame, and all that a renderer wants of it."""

    snapshot: Snapshot
    """Its triangles."""
    fading: Fading | None
    """What lingers of the frames before."""
    source: np.ndarray | None
    """Its picture, if a style looks at it."""
    masks: Mapping[str, np.ndarray]
    """The masks of regions that are not followed, by their names."""
    shares: np.ndarray | None
    """Which followed regions its triangles belong to, for all regions of the film [T, R]."""
    lay: Lay | None
    """How strokes lie."""
    choices: Mapping[int, Choices]
    """Which colours of their palettes triangles have taken, by the number of the section."""


class Wardrobe:
    """Draws frames in any look of a film.

    Args:
        device: Where kernels run.
        picture: Width and height of the source [px].
        drawn: Width and height of what is drawn [px].
        look: The look of the film, which knows all regions.
        model: The colour model that is optimised.

    Raises:
        OptionError: If the output is too large or has no pixel.
        MediaError: If a texture cannot be read.
    """

    def __init__(
        self,
        device: Device,
        picture: tuple[int, int],
        drawn: tuple[int, int],
        look: Look,
        model: ColorModel,
    ) -> None:
        self._device, self._picture, self._drawn, self._model = device, picture, drawn, model
        self._columns = {(r.mask, r.frames): place for place, r in enumerate(look.followed)}
        self._followed = len(look.followed)
        self._renderers: dict[Any, Renderer] = {}
        self._dressed: dict[int, Look] = {}

    def curtain(self, kind: str, size: tuple[int, int]) -> Curtain:
        """What draws the masks of a kind of transition.

        Args:
            kind: `scatter` or `grow`.
            size: Width and height of what is drawn [px].
        """
        return Curtain(self._device, self._picture, size, kind)

    def prepare(self, look: Look) -> Renderer:
        """The renderer for a look, with its parameters; made if there is none of its kind.

        Args:
            look: The look; without sections of its own.
        """
        styles = look.shown_styles(self._model)
        masked = tuple(region.style for region in look.regions)
        followed = tuple(i for i, region in enumerate(look.regions) if region.frames)
        kind = kind_of_stack(styles, masked, followed)
        found = self._renderers.get(kind)
        if found is None:
            found = Renderer(self._device, self._picture, self._drawn, styles, masked, followed)
            self._renderers[kind] = found
        elif self._dressed.get(id(found)) is not look:
            found.restyle(styles, masked)
        self._dressed[id(found)] = look
        return found

    def is_transparent(self, look: Look) -> bool:
        """Whether what is drawn in a look has alpha; nothing is made for it.

        Args:
            look: The look; without sections of its own.
        """
        masked = tuple(region.style for region in look.regions)
        followed = tuple(i for i, region in enumerate(look.regions) if region.frames)
        return channels_of(coats_of(look.shown_styles(self._model), masked, followed)) == 4

    def draw(self, look: Look, view: Posed, section: int = 0) -> np.ndarray:
        """Draw a frame.

        Args:
            look: How.
            view: The frame.
            section: Number of the section whose look it is.

        Returns:
            As `Renderer.render`.
        """
        renderer = self.prepare(look)
        shown = [view.masks[region.mask] for region in look.regions if not region.frames]
        columns = [self._columns[r.mask, r.frames] for r in look.regions if r.frames]
        everything = columns == list(range(self._followed))
        return renderer.render(
            view.snapshot,
            view.fading,
            view.source,
            shown,
            view.shares,
            view.lay,
            None if everything else columns,
            look.tone,
            view.choices.get(section),
        )
