"""Fits colours to meshes and draws them, as the output is drawn."""

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
from stages.look.framing import framed
from stages.motion.advect import Carried
from stages.snapshot import Snapshot
from stages.triangulate import Triangulator
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device

MOST_ACROSS = 1920
"""Widest picture that is drawn for the page [px]."""
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
        self._wardrobes: dict[tuple[int, int], Wardrobe] = {}

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

    def drawn(
        self, snapshot: Snapshot, frame: Frame | None, look: Look, time: float = 0.0
    ) -> np.ndarray:
        """A frame as the output shows it, at most `MOST_ACROSS` wide.

        Args:
            snapshot: The triangles.
            frame: The picture; None if the look does not show it.
            look: How they are drawn.
            time: When it is shown [s].

        Returns:
            Code values, [rows, columns, 3 or 4] uint8.
        """
        return self._drawn(snapshot, frame, look, time, MOST_ACROSS)

    def thumbnail(self, snapshot: Snapshot) -> np.ndarray:
        """A frame in small, in the colours of its triangles.

        Args:
            snapshot: The triangles.

        Returns:
            Code values, [rows, columns, 3] uint8.
        """
        return self._drawn(snapshot, None, look_of(()), 0.0, THUMBNAIL_ACROSS)

    def _drawn(
        self, snapshot: Snapshot, frame: Frame | None, look: Look, time: float, most: int
    ) -> np.ndarray:
        look = replace(look, scale=min(1.0, most / self._size[0]), output_size=None)
        framing = look.framing_for(self._size, Fraction(1))
        wardrobe = self._wardrobes.get(framing.picture)
        if wardrobe is None:
            wardrobe = Wardrobe(self._device, self._size, framing.picture, look, self.model)
            self._wardrobes[framing.picture] = wardrobe
        source = None if frame is None else frame.pixels
        view = Posed(snapshot, None, source, {}, None, None, {}, time)
        return framed(wardrobe.draw(look, view), framing, look.backdrop(self.model))

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


def look_of(styles: Sequence[str]) -> Look:
    """A look of styles as they are written on the command line.

    Args:
        styles: Bottom to top.

    Raises:
        OptionError: If there is no such style, or a value is impossible.
        MediaError: If a picture that it names cannot be read.
    """
    return fill(Look, values_of({"styles": list(styles)}))
