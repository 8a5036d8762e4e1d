"""Fits colours to meshes and draws them, as the output is drawn."""

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from pipeline.look.wardrobe import Posed, Wardrobe
from pipeline.loop.convert import triangulator_of
from pipeline.options.build import fill, values_of
from pipeline.options.look import Look
from pipeline.options.solve_options import SolveOptions
from stages.frame import Frame
from stages.hand.worked import Worked
from stages.look.framing import Framing, framed
from stages.masks.region import Region
from stages.motion.advect import Carried
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.styles import Style

MOST_ACROSS, MOST_DOWN = 1920, 4096
"""Widest and tallest picture that is drawn for the page [px]."""
MOST_WARDROBES = 6
"""Kinds of looks whose memory is kept."""
THUMBNAIL_ACROSS = 128
"""Widest thumbnail [px]."""


class Easel:
    """Works on frames of one size; used by one thread.

    Args:
        device: Where kernels run.
        options: How the clip was solved.
        size: Width and height of the source [px].
    """

    def __init__(self, device: Device, options: SolveOptions, size: tuple[int, int]) -> None:
        self._device, self._options, self._size = device, options, size
        self._triangulators: dict[str, Triangulator] = {}
        self._wardrobes: OrderedDict[object, Wardrobe] = OrderedDict()

    def fitted(self, frame: Frame, worked: Worked, model: ColorModel) -> Snapshot:
        """A mesh as it is, with the colours that fit it.

        Args:
            frame: The picture.
            worked: The mesh, and what is held of it.
            model: The colour model.
        """
        snapshot = self._triangulator(model).fit(frame, worked.mesh)
        return replace(snapshot, locks=worked.locks)

    def solved(self, frame: Frame, worked: Worked, model: ColorModel) -> Snapshot:
        """A mesh as the optimiser leaves it, just as a run over the whole shot has it.

        Args:
            frame: The picture.
            worked: The mesh, and what is held of it.
            model: The colour model.
        """
        return self._triangulator(model).next(frame, Carried.by_hand(worked))

    def ground(self, frame: Frame, model: ColorModel) -> Snapshot:
        """What a frame becomes that begins a shot, without an edit.

        Args:
            frame: The picture.
            model: The colour model.
        """
        rng = np.random.default_rng([self._options.seed, frame.index])
        return self._triangulator(model).first(frame, self._options.layout, rng)

    def prepare(self, look: Look, model: ColorModel, across: int = MOST_ACROSS) -> bool:
        """Make all that a look is drawn with.

        Args:
            look: The look.
            model: The colour model that it needs.
            across: See `drawn`.

        Returns:
            Whether kernels may have to be compiled first: `Device.compile_expected` does it beside
            all else, and drawing at once would do it while everything waits.
        """
        self._triangulator(model)
        look, framing = self._sized(look, across)
        self._wardrobe(framing.picture, look).prepare(look)
        return self._device.awaits_kernels

    def drawn(
        self,
        snapshot: Snapshot,
        frame: Frame | None,
        look: Look,
        time: float = 0.0,
        shares: np.ndarray | None = None,
        across: int = MOST_ACROSS,
    ) -> np.ndarray:
        """A frame as the output shows it.

        Args:
            snapshot: The triangles.
            frame: The picture; None if the look does not show it.
            look: How they are drawn.
            time: When it is shown [s].
            shares: Which followed regions of the look its triangles belong to, [T, R] uint8.
            across: Widest picture [px], at most `MOST_ACROSS`.

        Returns:
            Code values, [rows, columns, 3 or 4] uint8.
        """
        look, framing = self._sized(look, across)
        source = None if frame is None else frame.pixels
        view = Posed(snapshot, None, source, {}, shares, None, {}, time)
        pixels = self._wardrobe(framing.picture, look).draw(look, view)
        return framed(pixels, framing, look.backdrop(self.model))

    def thumbnail(self, snapshot: Snapshot) -> np.ndarray:
        """A frame in small, in the colours of its triangles.

        Args:
            snapshot: The triangles.

        Returns:
            Code values, [rows, columns, 3] uint8.
        """
        look = replace(look_of(()), scale=min(1.0, THUMBNAIL_ACROSS / self._size[0]))
        size = look.framing_for(self._size, Fraction(1)).picture
        view = Posed(snapshot, None, None, {}, None, None, {}, 0.0)
        return self._wardrobe(size, look).draw(look, view)

    def _sized(self, look: Look, across: int) -> tuple[Look, Framing]:
        """A look at the size of the page."""
        width, height = self._size
        scale = min(1.0, across / width, MOST_ACROSS / width, MOST_DOWN / height)
        look = replace(look, scale=scale, output_size=None)
        return look, look.framing_for(self._size, Fraction(1))

    def _wardrobe(self, size: tuple[int, int], look: Look) -> Wardrobe:
        """What draws a look; what draws looks with other styles is kept for a while."""
        layers: tuple[Style | Region, ...] = (*look.styles, *look.regions)
        key = size, look.followed, tuple(map(_kind_of, layers))
        if key not in self._wardrobes:
            made = Wardrobe(self._device, self._size, size, look, self.model)
            self._wardrobes[key] = made
        self._wardrobes.move_to_end(key)
        while len(self._wardrobes) > MOST_WARDROBES:
            self._wardrobes.popitem(last=False)
        return self._wardrobes[key]

    @property
    def model(self) -> ColorModel:
        """The colour model that is optimised."""
        return self._options.model

    def _triangulator(self, model: ColorModel) -> Triangulator:
        """What fits colours of a model."""
        if model.name not in self._triangulators:
            self._triangulators[model.name] = triangulator_of(
                self._options, self._size, self._device, model
            )
        return self._triangulators[model.name]


def _kind_of(layer: Style | Region) -> tuple[object, ...]:
    """What of a style, or a region's, has other memory: its numbers do not."""
    style = layer.style if isinstance(layer, Region) else layer
    return (type(style), *(getattr(style, name) for name in style.built_from))


def look_of(styles: Sequence[str]) -> Look:
    """A look of styles as they are written on the command line.

    Args:
        styles: Bottom to top.

    Raises:
        OptionError: If there is no such style, or a value is impossible.
        MediaError: If a picture that it names cannot be read.
    """
    return fill(Look, values_of({"styles": list(styles)}))
