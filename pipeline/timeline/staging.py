"""What a job becomes whose look changes over time: its file read, its times known."""

from dataclasses import replace
from functools import lru_cache

from pipeline.options.job import Job
from pipeline.options.look import Look
from pipeline.timeline.clock import Clock
from pipeline.timeline.show import Show
from pipeline.timeline.show_file import read_timeline
from pipeline.timeline.timeline import Timeline
from stages.hearing.heard import Heard
from stages.media import MediaInfo
from warp_kernels.color_model import ColorModel


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
        return look
    timeline = read_timeline(look.timeline, look)
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
    clock = Clock.of(info, heard_for(timeline, info))
    base = replace(look, sections=(), score=None)
    looks = (base, *(section.look for section in timeline.sections))
    shown = tuple(replace(one, styles=one.shown_styles(model)) for one in looks)
    return Show(timeline, clock, shown)


def heard_for(timeline: Timeline, info: MediaInfo) -> Heard | None:
    """What a timeline hears; nothing if it does not listen.

    Args:
        timeline: The timeline.
        info: The source.
    """
    if not timeline.needs_sound:
        return None
    if timeline.beats is not None:
        return timeline.beats
    if timeline.bpm is not None:
        seconds = float(info.duration or 0)
        return Heard.steady(max(seconds, 1.0), timeline.bpm, timeline.meter)
    return None
