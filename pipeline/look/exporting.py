"""Snapshots to shapes: what is written to formats of triangles instead of pixels."""

from contextlib import ExitStack
from types import TracebackType

from pipeline.envelope import Solved
from pipeline.look.smooth import Smoother
from pipeline.options.job import Job
from pipeline.options.look import Look
from stages.exchange import ending_of, format_of
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.writer import ShapeWriter
from stages.look.paint import paint_of
from stages.look.strokes import Strokes
from stages.media import MediaInfo, check_output
from stages.media.expected_frames import expected_frames
from stages.media.naming import NumberedPattern
from stages.media.writing.output_plan import OutputPlan
from stages.toning.choices import Choices
from stages.toning.tone import toned
from warp_kernels.drawing.paint import Paint
from warp_kernels.errors import OptionError
from warp_kernels.limits import SAMPLES


class Exporting:
    """The output of a job as shapes; a context manager that leaves no half of a file.

    Args:
        job: Says how the output looks and how it is written.
        info: The source; gives times and rate.

    Raises:
        OptionError: If an option does not fit the source or the format.
        OutputError: If the output cannot be written.
    """

    def __init__(self, job: Job, info: MediaInfo) -> None:
        plan, film = check_exporting(job, info)
        self._hidden = job.look.hidden
        self._start_time = info.start_time
        self._writer = ShapeWriter(plan, film)
        is_followed = not job.solve.independent
        self._smoother = Smoother(job.look.smooth if is_followed else 0.0)
        self._tone, self._is_followed = job.look.tone, is_followed
        self._choices = Choices.none()
        self._lays_strokes = is_followed and any(style.lays_strokes for style in film.styles)
        self._strokes: Strokes | None = None
        self._shot: int | None = None
        self._is_mixed = False

    @property
    def notes(self) -> list[str]:
        """Choices that were made, one sentence each; complete after the block."""
        mixed = ["--loop: shapes are not mixed, so that the film jumps where it begins anew"]
        return [*self._hidden, *(mixed if self._is_mixed else []), *self._writer.notes]

    def draw(self, solved: Solved) -> None:
        """Write a frame, or an earlier one that has been waiting for it."""
        for smooth in self._smoother.add(solved):
            self._write(smooth)

    def _write(self, solved: Solved) -> None:
        snapshot = solved.snapshot
        paint = self._painted(solved)
        if solved.blended_into is not None:
            self._is_mixed = True
        elif solved.is_shown:
            time = snapshot.pts * snapshot.time_base - self._start_time
            self._writer.write(Figure(snapshot, solved.shot, time, paint))

    def _painted(self, solved: Solved) -> Paint:
        """What styles see of a frame: strokes and colours go on from the one before."""
        mesh, is_other = solved.snapshot.mesh, solved.begins or solved.shot != self._shot
        begins = is_other or not self._is_followed
        self._shot = solved.shot
        if self._lays_strokes:
            known = None if begins else self._strokes
            self._strokes = Strokes.begin(mesh) if known is None else known.followed_by(mesh)
        lay = None if self._strokes is None else self._strokes.lay
        paint, palette = paint_of(solved.snapshot, None, lay), self._tone.palette
        if palette is not None and palette.is_nearest:
            known_colors = Choices.none() if begins else self._choices
            lab = self._tone.graded(paint.colors)
            self._choices = known_colors.followed_by(paint.ids, lab, palette)
        return toned(paint, self._tone, self._choices)

    def __enter__(self) -> "Exporting":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None:
            return
        with ExitStack() as closing:
            for solved in self._smoother.rest():
                self._write(solved)
            closing.callback(self._writer.close)


def check_exporting(
    job: Job, info: MediaInfo, triangles: int | None = None
) -> tuple[OutputPlan, Film]:
    """Find out before any work is done whether the output can be written.

    Args:
        job: Says how the output looks and how it is written.
        info: The source.
        triangles: How many a frame will have at most, as far as is known.

    Raises:
        OptionError: If an option does not fit the source or the format.
        OutputError: If the output cannot be written.
    """
    look, model = job.look, job.solve.model
    assert job.output.path is not None
    ending = ending_of(job.output.path)
    _refuse_time(look, ending)
    picture = (info.width, info.height)
    framing = look.framing_for(picture, info.sample_aspect)
    frames, is_numbered = job.solve.frame_range, bool(NumberedPattern.parse(job.output.path))
    film = Film(
        name=info.path.stem,
        ending=ending,
        size=picture,
        framing=framing,
        background=look.backdrop(model),
        styles=look.shown_styles(model),
        degree=look.fitted(model).degree,
        rate=None if info.kind == "image" else info.average_rate,
        frames=1 if frames.is_single or is_numbered else expected_frames(frames, info),
        triangles=triangles,
        options=job.output.exchange,
    )
    holder = format_of(job.output.path)
    if look.background is not None and not holder.is_drawn:
        raise OptionError(f"--background: {ending} has no ground; leave it out")
    holder.check(film)
    plan = check_output(job.output.path, info, framing.canvas, job.output.encode, frames)
    return plan, film


def _refuse_time(look: Look, ending: str) -> None:
    """Refuse what mixes looks in one frame: pictures can, shapes cannot. They have no samples."""
    for option, is_given in (
        ("--timeline", look.timeline is not None),
        ("--region", bool(look.regions)),
        ("--move", bool(look.moves)),
        ("--blend", look.blend > 0),
        ("--samples", look.samples != SAMPLES),
    ):
        if is_given:
            raise OptionError(f"{option}: {ending} cannot hold it; leave it out, or use .png")
