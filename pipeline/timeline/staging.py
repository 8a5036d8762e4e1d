"""What a job becomes whose look changes over time: its file read, its times known."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from pipeline.options.hearing import NOT_LISTENED
from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.ears import heard_for
from pipeline.timeline.show import Show
from pipeline.timeline.show_file import read_timeline
from pipeline.timeline.timeline import Timeline
from stages.hearing.beats_file import read_beats
from stages.hearing.heard import Heard
from stages.media import MediaInfo
from warp_kernels.color_model import ColorModel
from warp_kernels.errors import OptionError


def with_timeline(job: Job) -> Job:
    """The same job with what the file says that `--timeline` names.

    Args:
        job: The job.

    Raises:
        OptionError: If the file cannot be read, or holds anything that cannot be.
    """
    return replace(job, look=staged(job.look))


def staged(look: Look) -> Look:
    """A look with those of the sections that its timeline names.

    Args:
        look: The look.

    Raises:
        OptionError: As `with_timeline`.
    """
    if look.timeline is None:
        if look.hearing.beats is not None:
            raise OptionError(
                f"--beats {look.hearing.beats}: nothing looks at beats; give --timeline, too"
            )
        return look
    timeline = read_timeline(look.timeline, look)
    named = look.hearing.beats
    if named == NOT_LISTENED:
        timeline = replace(timeline, beats=None)
    elif named is not None:
        told = _beats_of(named).with_downbeats(timeline.meter if timeline.says_meter else None)
        timeline = replace(timeline, beats=told)
    looks = tuple(section.look for section in timeline.sections)
    return replace(look, sections=looks, score=timeline)


@lru_cache(maxsize=4)
def show_of(look: Look, model: ColorModel, info: MediaInfo) -> Show | None:
    """What is drawn when; None if nothing changes.

    Args:
        look: A look that is `staged`.
        model: The colour model that is optimised.
        info: The source.

    Raises:
        OptionError: If times are not in order, or beats are counted and there are none.
    """
    timeline = look.score
    if not isinstance(timeline, Timeline):
        return None
    heard, notes = heard_for(timeline, look.hearing, info)
    clock = Clock.of(info, heard)
    base = replace(look, sections=(), score=None)
    looks = (base, *(section.look for section in timeline.sections))
    shown = tuple(replace(one, styles=one.shown_styles(model)) for one in looks)
    return Show(timeline, clock, shown, notes)


def _beats_of(name: str) -> Heard:
    """The beats of the file that `--beats` names."""
    try:
        return read_beats(Path(name))
    except OSError as error:  # a name that no file can have
        reason = str(error.strerror or error).lower()
        raise OptionError(f"--beats {name[:30]}: {reason}; give the name of a file") from error
