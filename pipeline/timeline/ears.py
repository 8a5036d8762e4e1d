"""What a timeline hears, in the film's time: beats of a file, of a sound, or of a tempo."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pipeline.options.hearing import NOT_LISTENED, Hearing
from pipeline.timeline.timeline import Timeline
from stages.hearing.heard import Heard
from stages.media import MediaInfo
from warp_kernels.errors import MediaError

if TYPE_CHECKING:
    from stages.hearing.listening.listen import Listened

Told = tuple[Heard | None, tuple[str, ...]]
"""What is heard, and what is to be told of it."""
NOTHING: Told = (None, ())
"""Of a silent film."""


def heard_for(timeline: Timeline, hearing: Hearing, info: MediaInfo) -> Told:
    """What a timeline hears; nothing if it needs nothing.

    Beats come from a file if one is named, else from the sound: the song, or the film's own. Where
    there is no beat in it the timeline's tempo counts. Beats, strengths and onsets of which such a
    file does not tell come from the sound.

    Args:
        timeline: The timeline; `--beats` took the place of what it names.
        hearing: Which sound counts.
        info: The source.

    Raises:
        MediaError: If the song cannot be read.
    """
    if not timeline.needs_sound:
        return NOTHING
    told = timeline.beats
    found, notes = NOTHING
    if told is None or not told.has_beats or (timeline.hears_strengths and not told.envelopes):
        found, notes = _listened(timeline, hearing, info)
    heard = found if found is None or told is None else found.told_by(told)
    heard = heard or told
    if heard is not None and hearing.song is not None:
        heard = heard.moved(hearing.audio_offset)  # a file of beats begins where the song does
    if told is not None and timeline.hears_onsets and heard is not None and not len(heard.onsets):
        notes += (f"{timeline.file}: its beats tell of no onset; give --audio SONG",)
    if timeline.bpm is None or (heard is not None and heard.has_beats):
        return heard, notes
    steady = Heard.steady(max(float(info.duration or 0), 1.0), timeline.bpm, timeline.meter)
    return (steady if heard is None else heard.told_by(steady)), notes


def _listened(timeline: Timeline, hearing: Hearing, info: MediaInfo) -> Told:
    """What is heard in the song, or in the film's own sound."""
    song = hearing.song
    if hearing.beats == NOT_LISTENED or (song is None and info.audio_codec is None):
        return NOTHING
    path = info.path if song is None else song
    try:
        found = _listen(path, timeline.meter, path.stat().st_mtime_ns)
    except (MediaError, OSError) as error:
        if isinstance(error, OSError) and song is not None:
            reason = str(error.strerror or error).lower()
            raise MediaError(song, f"cannot be read ({reason})", "check the name") from error
        if song is not None:
            raise
        return None, (f"the film's sound is not heard: {error}",)
    bpm = found.heard.bpm
    notes = tuple(f"{path.name}: {note}" for note in found.notes)
    if bpm is not None:
        notes += (f"{path.name}: {bpm:.4g} beats a minute are heard; --beats FILE beats that",)
    elif timeline.bpm is not None:
        notes += (f"{path.name}: no beat is heard, so {timeline.bpm:g} beats a minute are counted",)
    return found.heard, notes


@lru_cache(maxsize=2)
def _listen(path: Path, meter: int, _changed: int) -> "Listened":
    """Listen once: plans, checks and drawings ask for the same sound."""
    from stages.hearing.listening.listen import listen  # which takes a second to import

    return replace(listen(path, meter=meter), wave=_NOTHING)


_NOTHING = np.zeros((0, 2), np.float32)
"""No wave: nobody draws it here."""
