"""Music whose beats are known: clicks, and a small band of kick, snare, hats, bass and pad.

All of it is made of sines and seeded noise. `play` gives sound, beats and downbeats of a piece.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

RATE = 44100
"""Samples a second."""
BARS = ((0, "minor"), (5, "major"), (3, "major"), (7, "major"))
"""Chords of the bars in turn: semitones above the key, and their kind."""
THIRDS = {"minor": (0, 3, 7), "major": (0, 4, 7)}
"""Semitones of a chord."""


@dataclass(frozen=True)
class Piece:
    """What is played."""

    bpm: float
    """Beats a minute at the beginning."""
    is_band: bool = True
    """Whether a band plays; else there are clicks."""
    meter: int = 4
    """Beats of a bar."""
    swing: float = 0.5
    """Where the second half of a beat begins, as a part of it."""
    drift: float = 0.0
    """By how much the tempo has changed at the end, as a part of it."""
    noise: bool = False
    """Whether noise as strong as the music is added."""
    silence: float = 0.0
    """How long nothing is heard before [s]."""
    seconds: float = 40.0
    """How long it is played [s]."""
    key: int = 0
    """Semitones above A."""


@dataclass(frozen=True, eq=False)
class Played:
    """A piece as it is heard."""

    sound: np.ndarray
    """Samples, -1 to 1, [N] float32, of one channel."""
    beats: np.ndarray
    """Times of beats [s]."""
    downbeats: np.ndarray
    """Times of the first beats of bars [s]."""


def play(piece: Piece, seed: int = 0) -> Played:
    """Play a piece.

    Args:
        piece: What is played.
        seed: Of noise, and of how the players sway.
    """
    rng = np.random.default_rng([seed, round(piece.bpm)])
    beats = _beats_of(piece)
    sound = np.zeros(round((piece.silence + piece.seconds + 0.5) * RATE), np.float32)
    if piece.is_band:
        _play_band(sound, piece, beats, rng)
    else:
        for number, time in enumerate(beats):
            add(sound, time, 0.8 * _click(1500.0 if number % piece.meter == 0 else 1000.0))
    if piece.noise:
        played = sound[round(piece.silence * RATE) :]
        level = float(np.sqrt((played.astype(float) ** 2).mean()))
        sound += level * rng.standard_normal(len(sound)).astype(np.float32)
    sound *= 0.9 / max(1e-9, float(np.abs(sound).max()))
    return Played(sound, beats, beats[:: piece.meter])


def _beats_of(piece: Piece) -> np.ndarray:
    """Times of the beats; a drifting tempo changes evenly."""
    times, time = [], piece.silence
    while time < piece.silence + piece.seconds:
        times.append(time)
        share = (time - piece.silence) / piece.seconds
        time += 60 / (piece.bpm * (1 + piece.drift * share))
    return np.array(times)


def _play_band(
    sound: np.ndarray, piece: Piece, beats: np.ndarray, rng: np.random.Generator
) -> None:
    low, high = kick(), snare(rng)
    for number, (time, after) in enumerate(pairwise(beats)):
        place, bar = number % piece.meter, number // piece.meter
        length = after - time
        root, kind = BARS[bar % len(BARS)]
        half = time + piece.swing * length
        strikes = place in (0, 2) if piece.meter == 4 else place == 0
        add(sound, _sway(time, rng), (0.8 * low) if strikes else (0.55 * high))
        if piece.meter == 4 and place == 2 and bar % 2:
            add(sound, _sway(half, rng), 0.6 * low)
        for at, loud in ((time, 0.22), (half, 0.14)):
            add(sound, _sway(at, rng), loud * rng.uniform(0.8, 1.1) * hat(rng))
        note = root + piece.key + (7 if place == piece.meter - 1 else 0)
        add(sound, _sway(time, rng), 0.35 * bass(note, length * 0.9))
        if place == 0:
            add(sound, time, 0.12 * pad(root + piece.key, kind, length * piece.meter))


def _sway(time: float, rng: np.random.Generator) -> float:
    """A moment as people hit it: 4 ms early or late."""
    return float(max(0.0, time + rng.normal(0, 0.004)))


def add(sound: np.ndarray, time: float, part: np.ndarray) -> None:
    """Add a part [N] to a sound [M] from a time [s] on; what does not fit is left out."""
    start = round(time * RATE)
    room = sound[start : start + len(part)]
    room += part[: len(room)].astype(np.float32)


def seconds_of(seconds: float) -> np.ndarray:
    """Times of the samples of a sound of so many seconds [s]."""
    return np.arange(round(seconds * RATE)) / RATE


def _click(pitch: float) -> np.ndarray:
    t = seconds_of(0.03)
    return np.sin(2 * np.pi * pitch * t) * np.exp(-t / 0.008)


def kick() -> np.ndarray:
    """A bass drum."""
    t = seconds_of(0.25)
    return np.sin(2 * np.pi * (50 * t + 4 * (1 - np.exp(-t / 0.03)))) * np.exp(-t / 0.08)


def snare(rng: np.random.Generator) -> np.ndarray:
    """A snare drum."""
    t = seconds_of(0.2)
    rattle = rng.standard_normal(len(t)) * np.exp(-t / 0.06)
    return 0.5 * rattle + 0.5 * np.sin(2 * np.pi * 190 * t) * np.exp(-t / 0.05)


def hat(rng: np.random.Generator) -> np.ndarray:
    """A closed hi-hat."""
    t = seconds_of(0.06)
    return np.diff(rng.standard_normal(len(t)), prepend=0.0) * np.exp(-t / 0.015)


def bass(note: float, seconds: float) -> np.ndarray:
    """A bass, so many semitones above A."""
    t = seconds_of(seconds)
    pitch = 55.0 * 2 ** (note / 12)
    tone = sum(np.sin(2 * np.pi * n * pitch * t) / n**1.5 for n in range(1, 6))
    return np.asarray(tone * np.minimum(1, t / 0.008) * np.exp(-t / 0.5))


def pad(root: float, kind: str, seconds: float) -> np.ndarray:
    """A held chord, so many semitones above A and of a kind of `THIRDS`."""
    t = seconds_of(seconds)
    tones = [220.0 * 2 ** ((root + step) / 12) for step in THIRDS[kind]]
    chord = sum(np.sin(2 * np.pi * f * t) + 0.4 * np.sin(4 * np.pi * f * t) for f in tones)
    return np.asarray(chord * np.minimum(1, np.minimum(t / 0.08, (seconds - t) / 0.08)))
