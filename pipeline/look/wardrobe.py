"""One renderer for every kind of stack that a film is drawn with."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.options.look import Look
from stages.look.fading import Fading
from stages.look.veil import Curtain
from stages.masks.region import Region
from stages.moves.staged import moved_by
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.toning.choices import Choices
from stages.toning.tone import Tone
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.drawing.coats import coats_of
from warp_kernels.drawing.moved import Moved
from warp_kernels.drawing.shade import channels_of
from warp_kernels.drawing.stack_kind import kind_of_stack
from warp_kernels.scene.stroke_lay import Lay
from warp_kernels.styles import Style
from warp_kernels.styles.backcloth import Backcloth


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
    time: float = 0.0
    """When it is shown [s from the beginning of the film]."""


@dataclass(frozen=True)
class Stack:
    """Styles that one renderer draws."""

    styles: tuple[Style, ...]
    """Bottom to top."""
    regions: tuple[Region, ...] = ()
    """Those over them, inside of masks."""
    moves: bool = False
    """Whether it draws triangles elsewhere than they lie."""

    @property
    def parts(self) -> tuple[tuple[Style, ...], tuple[Style, ...], tuple[int, ...], bool]:
        """What a renderer is made of."""
        masked = tuple(region.style for region in self.regions)
        followed = tuple(i for i, region in enumerate(self.regions) if region.frames)
        return self.styles, masked, followed, self.moves


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
        self._samples = look.samples
        self._columns = {(r.mask, r.frames): place for place, r in enumerate(look.followed)}
        self._followed = len(look.followed)
        self._renderers: dict[Any, Renderer] = {}
        self._dressed: dict[int, Stack] = {}

    def curtain(self, kind: str, size: tuple[int, int]) -> Curtain:
        """What draws the masks of a kind of transition.

        Args:
            kind: `scatter` or `grow`.
            size: Width and height of what is drawn [px].
        """
        return Curtain(self._device, self._picture, size, kind)

    def prepare(self, look: Look) -> None:
        """Make all that a look is drawn with.

        Args:
            look: The look; without sections of its own.
        """
        for stack in (self._still(look), *self._moving(look)):
            self._renderer(stack)

    def _renderer(self, stack: Stack) -> Renderer:
        """The renderer for a stack, with its parameters; made if there is none of its kind."""
        kind = kind_of_stack(*stack.parts)
        found = self._renderers.get(kind)
        if found is None:
            found = Renderer(
                self._device, self._picture, self._drawn, *stack.parts, samples=self._samples
            )
            self._renderers[kind] = found
        elif self._dressed.get(id(found)) != stack:
            found.restyle(*stack.parts[:2])
        self._dressed[id(found)] = stack
        return found

    def _still(self, look: Look) -> Stack:
        """What a look is where nothing moves."""
        return Stack(look.shown_styles(self._model), look.regions)

    def _moving(self, look: Look) -> tuple[Stack, ...]:
        """What it is where triangles move: the sheet that lies under them, if any, then the rest.

        What lies under a sheet is hidden.
        """
        if all(move.is_idle for move in look.moves):
            return ()
        styles = look.shown_styles(self._model)
        sheets = [number for number, style in enumerate(styles) if style.is_sheet]
        if not sheets:
            return (Stack(styles, look.regions, moves=True),)
        above = (Backcloth(), *styles[sheets[-1] + 1 :])
        return Stack((styles[sheets[-1]],)), Stack(above, look.regions, moves=True)

    def is_transparent(self, look: Look) -> bool:
        """Whether what is drawn in a look has alpha; nothing is made for it.

        Args:
            look: The look; without sections of its own.
        """
        return channels_of(coats_of(*self._still(look).parts)) == 4

    def has_holes(self, look: Look) -> bool:
        """Whether what is drawn in a look has holes while triangles move; nothing is made for it.

        Args:
            look: The look; without sections of its own.
        """
        return any(channels_of(coats_of(*one.parts)) == 4 for one in self._moving(look)[-1:])

    def draw(self, look: Look, view: Posed, section: int = 0) -> np.ndarray:
        """Draw a frame.

        Args:
            look: How.
            view: The frame.
            section: Number of the section whose look it is.

        Returns:
            As `Renderer.render`.
        """
        tone = look.tone, view.choices.get(section)
        moved = moved_by(look.moves, view.snapshot, view.time)
        if moved is None:
            return self._render(self._still(look), view, tone)
        *sheet, above = self._moving(look)
        ground = self._render(sheet[0], view, tone) if sheet else None
        return self._render(above, view, tone, moved, ground)

    def _render(
        self,
        stack: Stack,
        view: Posed,
        tone: tuple[Tone, Choices | None],
        moved: Moved | None = None,
        ground: np.ndarray | None = None,
    ) -> np.ndarray:
        """Draw a frame with one stack."""
        regions = stack.regions
        shown = [view.masks[region.mask] for region in regions if not region.frames]
        columns = [self._columns[r.mask, r.frames] for r in regions if r.frames]
        everything = columns == list(range(self._followed))
        return self._renderer(stack).render(
            view.snapshot,
            view.fading,
            view.source,
            shown,
            view.shares,
            view.lay,
            None if everything else columns,
            *tone,
            moved,
            ground,
        )
