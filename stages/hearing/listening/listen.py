"""Listen to a sound: all that is heard in it."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from stages.hearing.formats.json_form import as_json, from_json
from stages.hearing.heard import USUAL_METER, Heard, usual_bpm
from stages.hearing.listening.attacks import set_in
from stages.hearing.listening.bars import downbeats_of
from stages.hearing.listening.beats import beats_of
from stages.hearing.listening.envelopes import SILENCE, envelopes_of
from stages.hearing.listening.octave import octave_of
from stages.hearing.listening.onsets import onsets_of
from stages.hearing.listening.spectrum import FRAMES, RATE, Spectrum, spectrum_of
from stages.hearing.listening.strength import Rising, strength_of
from stages.hearing.listening.tempo import tempo_of
from stages.media.sound.samples import SampleForm, samples_of

CLEAR_OF = (4.0, 8.0), (0.52, 0.4)
"""In sounds of so many seconds what begins repeats as well as this where there is a beat: in short
ones noise repeats, too."""
SHORTEST = 3.0
"""How long a sound with a beat is at least [s]."""
FEWEST = 4
"""Beats at least."""
QUIET = 0.003
"""Beats at the ends are dropped where the sound is quieter than this part of what is loud."""
LATE = 0.4
"""By how many spectra a beginning is later than it is seen: windows reach ahead."""


NO_BEAT = "no steady beat is heard"


@dataclass(frozen=True, eq=False)
class Listened:
    """What is heard, and what is to be told of it."""

    heard: Heard
    """Beats, bars, onsets and envelopes, rounded as their file is."""
    notes: tuple[str, ...]
    """One sentence each."""
    wave: np.ndarray
    """Peaks and root mean squares of the samples, `FRAMES` a second, [N, 2] float32."""


def listen(path: Path, bpm: float | None = None, meter: int = USUAL_METER) -> Listened:
    """Listen to a file's sound.

    Args:
        path: What FFmpeg reads; of a film times count from its first picture.
        bpm: About the tempo, if it is known.
        meter: Beats of a bar.

    Raises:
        MediaError: If it is not readable or holds no sound.
    """
    problems: list[str] = []
    spectrum = spectrum_of(samples_of(path, SampleForm(RATE), problems))
    heard, notes = heard_in(spectrum, bpm, meter)
    wave = np.stack([spectrum.peak, spectrum.rms], axis=1)
    return Listened(from_json(as_json(heard)), (*problems, *notes), wave)


def heard_in(spectrum: Spectrum, bpm: float | None, meter: int) -> tuple[Heard, tuple[str, ...]]:
    """What is heard in a spectrum, and what is to be told of it.

    Args:
        spectrum: The sound.
        bpm: About the tempo, if it is known.
        meter: Beats of a bar.
    """
    envelopes = envelopes_of(spectrum)
    if not (spectrum.rms > SILENCE).any():
        heard = Heard(spectrum.duration, envelopes=envelopes, meter=meter)
        return _steady(heard, bpm), ("it is silent",)
    strength = strength_of(spectrum)
    beats = _beats(spectrum, strength, bpm)
    times = set_in(spectrum, np.maximum((beats + LATE) / FRAMES, 0))
    heard = Heard(
        spectrum.duration,
        usual_bpm(times),
        times,
        times[downbeats_of(spectrum, strength, beats, meter)],
        np.unique(set_in(spectrum, np.maximum((onsets_of(strength) + LATE) / FRAMES, 0))),
        envelopes,
        meter=meter,
    )
    if len(times):
        return heard, ()
    is_short = spectrum.duration < SHORTEST
    return _steady(heard, bpm), ("it is too short for a beat" if is_short else NO_BEAT,)


def _beats(spectrum: Spectrum, strength: Rising, bpm: float | None) -> np.ndarray:
    """Beats, as places between spectra; none where there is no beat."""
    if spectrum.duration < SHORTEST and bpm is None:
        return np.empty(0)
    tempo = tempo_of(strength.whole, bpm)
    least = float(np.interp(spectrum.duration, CLEAR_OF[0], CLEAR_OF[1]))
    if tempo.clarity < least and bpm is None:
        return np.empty(0)
    beats = beats_of(strength.whole, tempo.bpm)
    factor = 1.0 if bpm is not None else octave_of(strength, beats, float(np.median(tempo.bpm)))
    if factor != 1.0:
        beats = beats_of(strength.whole, tempo.bpm * factor)
    beats = _without_silent_ends(beats, spectrum.rms)
    return beats if len(beats) >= FEWEST else np.empty(0)


def _without_silent_ends(beats: np.ndarray, rms: np.ndarray) -> np.ndarray:
    """Beats from the first to the last one after which something is heard."""
    if len(beats) < 2:
        return beats
    quiet = max(SILENCE, QUIET * float(np.quantile(rms, 0.99)))
    known = np.concatenate([[0], np.cumsum(rms > quiet)])
    half = 0.5 * float(np.median(np.diff(beats)))
    begins = np.clip(beats - 3, 0, len(rms)).astype(int)
    ends = np.clip(beats + half, 0, len(rms)).astype(int)
    sounding = np.flatnonzero(known[ends] > known[begins])
    return beats[sounding[0] : sounding[-1] + 1] if len(sounding) else beats[:0]


def _steady(heard: Heard, bpm: float | None) -> Heard:
    """With beats of the tempo that was said, from the first onset on."""
    if bpm is None:
        return heard
    first = float(heard.onsets[0]) if len(heard.onsets) else 0.0
    steady = Heard.steady(heard.duration, bpm, heard.meter, first)
    return replace(heard, bpm=bpm, beats=steady.beats, downbeats=steady.downbeats)
