"""Play `song.ogg`: four bars at 125 beats a minute, a beat every twelve frames of 25 a second.

    PYTHONPATH=. python sample_videos/make_song.py [OUTPUT.ogg]

A pad and a bell alone, then kick and bass, then the whole band, and a fill at the end. All of it is
made of sines and seeded noise (`benchmarks/made_music.py`).
"""

import argparse
from pathlib import Path

import av
import numpy as np

from benchmarks.made_music import BARS, RATE, THIRDS, add, bass, hat, kick, pad, seconds_of, snare

BEAT = 60 / 125
"""Length of a beat [s]."""
OPUS_RATE = 48_000
"""Samples a second of Opus."""
METER, BAR_COUNT = 4, 4
"""Beats of a bar, and bars."""
SECONDS = METER * BAR_COUNT * BEAT
"""Length of the song [s]."""


def play() -> np.ndarray:
    """Play the song.

    Returns:
        Samples, -1 to 1, [2, N] float32.
    """
    rng = np.random.default_rng(125)
    middle, side = np.zeros((2, round(SECONDS * RATE)), np.float32)
    for bar in range(BAR_COUNT):
        _play_tune(middle, side, bar)
        if bar > 0:
            _play_drums(middle, bar, rng)
    both = np.stack([middle + side, middle - side])
    both *= np.minimum(1, (SECONDS - seconds_of(SECONDS)) / 0.05)
    return (0.9 * both / np.abs(both).max()).astype(np.float32)


def _play_tune(middle: np.ndarray, side: np.ndarray, bar: int) -> None:
    """Pad, bass and a bell that runs through the chord, left and right in turn."""
    root, kind = BARS[bar]
    begin = bar * METER * BEAT
    add(middle, begin, 0.14 * pad(root, kind, METER * BEAT))
    chord = (*THIRDS[kind], 12)
    for eighth in range(2 * METER):
        note = root + chord[(0, 2, 3, 1, 2, 3, 1, 2)[eighth]]
        rung = 0.12 * _bell(note)
        add(middle, begin + eighth * BEAT / 2, rung)
        add(side, begin + eighth * BEAT / 2, 0.5 * (-1) ** eighth * rung)
        if bar > 0:
            low = root - 12 if root > 4 else root
            add(middle, begin + eighth * BEAT / 2, 0.22 * bass(low, 0.45 * BEAT))


def _play_drums(middle: np.ndarray, bar: int, rng: np.random.Generator) -> None:
    """Kick on every beat; snare and hats from the third bar on, and a fill in the last beat."""
    begin = bar * METER * BEAT
    for beat in range(METER):
        time = begin + beat * BEAT
        add(middle, time, 0.85 * kick())
        if bar > 1:
            add(middle, time + BEAT / 2, 0.25 * hat(rng))
            if beat % 2:
                add(middle, time, 0.5 * snare(rng))
    if bar == BAR_COUNT - 1:
        for part in (1, 2, 3):
            add(middle, begin + (3 + part / 4) * BEAT, (0.2 + 0.1 * part) * snare(rng))


def _bell(note: float) -> np.ndarray:
    """A bell, so many semitones above the A of 440 Hz."""
    t = seconds_of(0.5)
    pitch = 440.0 * 2 ** (note / 12)
    tone = np.sin(2 * np.pi * pitch * t + 1.5 * np.exp(-t / 0.1) * np.sin(7 * np.pi * pitch * t))
    return np.asarray(tone * np.minimum(1, t / 0.003) * np.exp(-t / 0.14))


def write(sound: np.ndarray, path: Path) -> None:
    """Write samples [2, N] as Opus of about 96 kbit/s."""
    with av.open(str(path), "w") as file:
        stream = file.add_stream("libopus", rate=OPUS_RATE, layout="stereo")
        stream.bit_rate = 96_000
        played = av.AudioFrame.from_ndarray(np.ascontiguousarray(sound), "fltp", "stereo")
        played.sample_rate, played.pts = RATE, 0
        resampler = av.AudioResampler("flt", "stereo", OPUS_RATE)
        for frame in (*resampler.resample(played), *resampler.resample(None), None):
            file.mux(stream.encode(frame))


def main() -> None:
    """Read the command line and write."""
    parser = argparse.ArgumentParser(description="Play the song of the sample clips.")
    parser.add_argument("output", type=Path, nargs="?", default=Path(__file__).parent / "song.ogg")
    write(play(), parser.parse_args().output)


if __name__ == "__main__":
    main()
