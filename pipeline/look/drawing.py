"""Snapshots to frames of the output: drawn and encoded."""

from contextlib import ExitStack
from dataclasses import replace
from types import TracebackType

from pipeline.envelope import Solved
from pipeline.look.region_masks import own_mask
from pipeline.look.smooth import Smoother
from pipeline.look.stage import Looks, Posed, check_stage, open_stage
from pipeline.options.job import Job
from pipeline.stage_times import StageTimes
from stages.look.fading import Fading
from stages.look.folded import Folded
from stages.look.framing import Framing
from stages.look.paint import paint_of
from stages.look.strokes import Strokes
from stages.look.transitions import faded
from stages.masks.regions import Mask, open_masks
from stages.media import MediaInfo, check_output, open_encoder
from stages.metrics.flashes import FlashWatch
from stages.toning.choices import Choices
from warp_kernels.device.device import Device
from warp_kernels.scene.stroke_lay import Lay


class Drawing:
    """The output of a job; a context manager that leaves nothing under its name on a failure.

    Args:
        job: Says how the output looks and how it is written.
        info: The source; gives times, pixel aspect and sound.
        device: Where kernels run.
        times: Told how long encoding takes.

    Raises:
        OptionError: If an option does not fit the source.
        OutputError: If the output cannot be written.
    """

    def __init__(self, job: Job, info: MediaInfo, device: Device, times: StageTimes) -> None:
        self._times = times
        picture = (info.width, info.height)
        options, look, output = job.solve, job.look, job.output
        assert output.path is not None
        self._framing = look.framing_for(picture, info.sample_aspect)
        self._hidden = look.hidden
        self._start_time = info.start_time
        self._stage = open_stage(device, job, info, self._framing)
        self._unfollowed = dict.fromkeys(region.mask for region in look.unfollowed)
        self._picture = picture
        self._masks = {name: Mask(name, picture) for name in self._unfollowed}
        self._seam = options.seam
        self._leading: dict[int, Folded] = {}  # what is blended into frames to come
        self._encoder = open_encoder(
            output.path,
            _shown(info, self._framing),
            self._framing.canvas,
            output.encode,
            options.frame_range,
        )
        # stills are looked at one by one
        self._watch = None if self._encoder.plan.container is None else FlashWatch()
        # Where every frame starts anew, triangles of the same number have nothing in common.
        self._blend = 0 if options.independent else look.blend
        self._smoother = Smoother(0.0 if options.independent else look.smooth)
        self._lays_strokes = look.lays_strokes and not options.independent
        self._fading: Fading | None = None
        self._strokes: Strokes | None = None
        self._holds_colors = look.holds_colors and not options.independent
        self._choices: dict[int, Choices] = {}
        self._shot: int | None = None

    @property
    def notes(self) -> list[str]:
        """Choices that were made, one sentence each; complete after the block."""
        fitted = _fitted(self._framing)
        found = None if self._watch is None else self._watch.found
        flashes = [] if found is None else [found.note]
        return [*self._hidden, *fitted, *self._stage.notes, *self._encoder.notes, *flashes]

    def draw(self, solved: Solved) -> None:
        """Draw and encode a frame, or an earlier one that has been waiting for it."""
        for smooth in self._smoother.add(solved):
            self._draw(smooth)

    def _draw(self, solved: Solved) -> None:
        self._follow(solved)
        if solved.is_shown:
            snapshot = solved.snapshot
            index, shown = solved.standing.frame, solved.standing.time
            looks = self._looks_at(solved)
            masks = {name: self._masks[name].at(index) for name in looks.masks}
            view = Posed(
                snapshot,
                self._fading,
                solved.source,
                masks,
                solved.shares,
                self._lay,
                self._choices,
                float(shown - self._start_time),
            )
            pixels = self._stage.draw(looks, view)
            if solved.blended_into is not None:
                self._leading[index] = Folded.of(pixels)
                return
            leading, partner = self._leading.pop(index, None), self._seam.partner_of(index)
            if leading is not None and partner is not None:
                pixels = faded(pixels, leading.pixels(), partner[1])
            if self._watch is not None:
                self._watch.add(pixels, shown - self._start_time)
            with self._times.spent("encoding"):
                self._encoder.write(pixels, snapshot.pts, snapshot.time_base, snapshot.frame_index)

    def _looks_at(self, solved: Solved) -> Looks:
        """What is drawn at a frame."""
        standing = solved.standing
        shown = standing.time - self._start_time
        return self._stage.looks_at(standing.frame, shown, standing.shot)

    def _hold_colors(self, solved: Solved, *, begins: bool) -> None:
        """Let triangles keep the colours of palettes that they took in the frame before."""
        before = {} if begins else self._choices
        self._choices = {}
        paint = paint_of(solved.snapshot)
        for scene in self._looks_at(solved).scenes:
            tone = scene.look.tone
            if tone.palette is not None and tone.palette.is_nearest:
                known = before.get(scene.section, Choices.none())
                lab = tone.graded(paint.colors)
                self._choices[scene.section] = known.followed_by(
                    paint.ids, lab, tone.palette, self._blend
                )

    def _follow(self, solved: Solved) -> None:
        """Take on what lies on a frame from the one before, and what lingers of it."""
        begins, snapshot = solved.begins or solved.shot != self._shot, solved.snapshot
        if solved.begins:
            self._open_masks()
        self._shot = solved.shot
        if self._lays_strokes:
            known = None if begins else self._strokes
            mesh = snapshot.mesh
            self._strokes = Strokes.begin(mesh) if known is None else known.followed_by(mesh)
        if self._holds_colors:
            self._hold_colors(solved, begins=begins)
        if self._blend:
            fading = None if begins else self._fading
            if fading is None:
                self._fading = Fading.begin(snapshot, self._blend, solved.shares, self._lay)
            else:
                self._fading = fading.followed_by(snapshot, solved.shares, self._lay)

    @property
    def _lay(self) -> Lay | None:
        """How the strokes of the frame lie, if they go on from the one before."""
        return None if self._strokes is None else self._strokes.lay

    def __enter__(self) -> "Drawing":
        self._encoder.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None:
            self._close_masks()
            self._encoder.__exit__(kind, error, trace)
            return
        with self._times.spent("encoding"), ExitStack() as closing:
            closing.push(self._encoder)  # a failure of the last frames leaves nothing either
            closing.callback(self._close_masks)
            for solved in self._smoother.rest():
                with self._times.spent("drawing"):
                    self._draw(solved)

    def _open_masks(self) -> None:
        """Read masks from their beginning again."""
        self._close_masks()
        self._masks = {name: Mask(name, self._picture) for name in self._unfollowed}

    def _close_masks(self) -> None:
        for mask in self._masks.values():
            mask.close()


def check_drawing(job: Job, info: MediaInfo) -> None:
    """Find out before any work is done whether the output can be written.

    Args:
        job: Says how the output looks and how it is written.
        info: The source.

    Raises:
        OptionError: If an option does not fit the source.
        MediaError: If a mask cannot be read.
        OutputError: If the output cannot be written.
    """
    picture = (info.width, info.height)
    check_stage(job, info)
    for mask in open_masks(job.look.unfollowed, picture):
        mask.close()
    for region in job.look.followed:
        for frame in region.frames:
            own_mask(region, frame, picture)
    assert job.output.path is not None
    framing = job.look.framing_for(picture, info.sample_aspect)
    check_output(
        job.output.path,
        _shown(info, framing),
        framing.canvas,
        job.output.encode,
        job.solve.frame_range,
    )


def _shown(info: MediaInfo, framing: Framing) -> MediaInfo:
    """The source as the canvas shows it, whose pixels may have another shape."""
    if framing.sample_aspect is None:
        return info
    width, height = framing.canvas
    return replace(info, width=width, height=height, sample_aspect=framing.sample_aspect)


def _fitted(framing: Framing) -> list[str]:
    """What is told of a picture with bars; what is cut off was asked for."""
    if framing.is_plain or min(framing.offset) < 0:
        return []
    drawn, whole = ("{}x{}".format(*size) for size in (framing.picture, framing.canvas))
    return [f"the picture is {drawn}, with bars to {whole}; --fit cover fills it"]
