"""What is drawn at a frame: the look of its moment, or two on the way from one to the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from pipeline.look.wardrobe import Posed, Wardrobe
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.timeline.show import Instant, Setting, Show
from pipeline.timeline.staging import show_of
from stages.look.framing import Framing, framed
from stages.look.transitions import apart, faded, thinned, through, wiped, with_alpha
from stages.look.veil import WAITING, Curtain
from stages.media import MediaInfo, keeps_alpha
from stages.moves.staged import check_moment
from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device

__all__ = ["Looks", "Posed", "Stage", "check_stage", "open_stage"]

BLACK = (0.0, 0.0, 0.0)
"""Behind a picture that has no background of its own [code values]."""


@dataclass(frozen=True)
class Looks:
    """What is drawn at a frame."""

    moment: Instant
    """The section, or two."""

    @property
    def scenes(self) -> Sequence[Setting]:
        """The scenes that are drawn."""
        before = self.moment.before
        return (self.moment.scene,) if before is None else (before, self.moment.scene)

    @property
    def masks(self) -> list[str]:
        """Names of the masks that are looked at."""
        regions = [region for scene in self.scenes for region in scene.look.regions]
        return list(dict.fromkeys(region.mask for region in regions if not region.frames))


class Stage:
    """Draws frames as the moment wants it.

    Args:
        wardrobe: Draws frames in one look.
        framing: Where the picture lies on the output.
        look: The look of the film.
        model: The colour model that is optimised.
        show: What is drawn when; None if nothing changes.
        frames: Numbers of the first and the last frame that are drawn, as far as is known.
        film: Those of the whole film, in the same way.
        keeps_alpha: Whether what is written has room for transparency.
    """

    def __init__(
        self,
        wardrobe: Wardrobe,
        framing: Framing,
        look: Look,
        model: ColorModel,
        show: Show | None,
        frames: tuple[int, int],
        film: tuple[int, int],
        keeps_alpha: bool,
    ) -> None:
        self._wardrobe, self._framing, self._model, self._show = wardrobe, framing, model, show
        self._steady = Instant(Setting(0, look))
        self._is_alpha = False
        self._film = film
        self._curtains: dict[str, Curtain] = {}
        for kind in () if show is None else show.transitions:
            if kind in WAITING:
                self._curtain(kind)
        for scene in [self._steady.scene] if show is None else show.foreseen(*frames):
            wardrobe.prepare(scene.look)
        # of the whole film, whatever range of it is drawn: opacity means alpha then
        for scene in [self._steady.scene] if show is None else show.foreseen(*film):
            backdrop = scene.look.backdrop(model)
            is_open = keeps_alpha and wardrobe.has_holes(scene.look)
            self._is_alpha |= backdrop is None and (is_open or wardrobe.is_transparent(scene.look))

    @property
    def notes(self) -> tuple[str, ...]:
        """What is told of a timeline, one sentence each."""
        if self._show is None:
            return ()
        return (*self._show.notes, *self._show.held(*self._film))

    def looks_at(self, index: int, shown: Fraction, shot: int) -> Looks:
        """What is drawn at a frame.

        Args:
            index: Its number in the source.
            shown: When it is shown [s from the first frame].
            shot: Number of the frame with which its shot begins.
        """
        if self._show is None:
            return Looks(self._steady)
        return Looks(self._show.at(index, shown, shot))

    def draw(self, looks: Looks, view: Posed) -> np.ndarray:
        """Draw a frame.

        Args:
            looks: How.
            view: The frame.

        Returns:
            Code values, [rows, columns, 3 or 4] uint8, as many for all frames.
        """
        moment = looks.moment
        pixels = self._drawn(moment.scene, view)
        if moment.before is None or moment.transition is None:
            return pixels
        before, kind = self._drawn(moment.before, view), moment.transition.kind
        if kind == "wipe":
            return wiped(before, pixels, moment.share, moment.transition.direction)
        if kind == "fade":
            return faded(before, pixels, moment.share)
        weights = self._curtain(kind).weights(view.snapshot, moment.share)
        one, other = (self._framed_mask(part) for part in weights)
        if kind == "scatter":
            return through(before, pixels, other)
        return apart(before, pixels, (one, other), self._ground(moment))

    def _ground(self, moment: Instant) -> tuple[float, float, float]:
        """What is seen between triangles that shrink away."""
        assert moment.before is not None
        grounds = [one.look.backdrop(self._model) for one in (moment.before, moment.scene)]
        return grounds[0] or grounds[1] or BLACK

    def _curtain(self, kind: str) -> Curtain:
        """What draws the masks of a transition; made once, before the first frame if foreseen."""
        if kind not in self._curtains:
            size = self._framing.picture
            self._curtains[kind] = self._wardrobe.curtain(kind, size)
        return self._curtains[kind]

    def _framed_mask(self, mask: np.ndarray) -> np.ndarray:
        """A mask on the canvas: bars change with the picture's edges."""
        if self._framing.is_plain:
            return mask
        across, down = self._framing.offset
        width, height = self._framing.canvas
        rows = np.clip(np.arange(height) - down, 0, mask.shape[0] - 1)
        columns = np.clip(np.arange(width) - across, 0, mask.shape[1] - 1)
        return mask[np.ix_(rows, columns)]

    def _drawn(self, scene: Setting, view: Posed) -> np.ndarray:
        """One scene on its canvas."""
        backdrop = scene.look.backdrop(self._model)
        pixels = self._wardrobe.draw(scene.look, view, scene.section)
        if self._is_alpha:
            pixels = with_alpha(pixels)
        elif pixels.shape[2] == 4 and backdrop is None:
            backdrop = BLACK
        pixels = framed(pixels, self._framing, backdrop)
        if self._is_alpha:  # a background has filled what was open
            pixels = with_alpha(pixels)
        return thinned(pixels, backdrop or BLACK, scene.opacity)


def open_stage(device: Device, job: Job, info: MediaInfo, framing: Framing) -> Stage:
    """Make what draws the frames of a job.

    Args:
        device: Where kernels run.
        job: Says how the output looks.
        info: The source.
        framing: Where the picture lies on the output.

    Raises:
        OptionError: If an option does not fit the source.
        MediaError: If a texture cannot be read.
    """
    look, model = job.look, job.solve.model
    wardrobe = Wardrobe(device, (info.width, info.height), framing.picture, look, model)
    show = show_of(look, model, info)
    output = job.output
    has_room = output.path is not None and keeps_alpha(output.path, output.encode)
    return Stage(wardrobe, framing, look, model, show, _frames(job, info), _film(info), has_room)


def check_stage(job: Job, info: MediaInfo) -> None:
    """Find out before any work is done whether the times and curves of a timeline hold.

    Args:
        job: The job.
        info: Its source.

    Raises:
        OptionError: If they do not.
    """
    show, film = show_of(job.look, job.solve.model, info), _film(info)
    if show is not None:
        show.check(*film)
    if info.last_frame == info.first_frame:
        for look in [job.look] if show is None else [one.look for one in show.foreseen(*film)]:
            check_moment(look.moves)


def _film(info: MediaInfo) -> tuple[int, int]:
    """Numbers of the first and the last frame of a film, as far as is known."""
    return info.first_frame, info.first_frame if info.last_frame is None else info.last_frame


def _frames(job: Job, info: MediaInfo) -> tuple[int, int]:
    """Numbers of the first and the last frame that are drawn, as far as is known."""
    wanted = job.solve.frame_range
    start, last = _film(info)
    first = min(max(wanted.first, start), last)
    return first, last if wanted.last is None else min(max(wanted.last, first), last)
