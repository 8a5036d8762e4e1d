"""How well beats and bars are heard, in music whose beats are known, and how long it takes.

Run it in the root of the repository: python -m benchmarks.listening [--seconds 40] [--speed]

Beats count after 5 s, within 70 ms, each once, as in mir_eval (Raffel et al., ISMIR 2014).
"""

import argparse
import subprocess
import sys
import tempfile
import wave
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.made_music import RATE, Piece, Played, play
from stages.hearing.heard import Heard
from stages.hearing.listening.listen import listen

TEMPOS = (72, 92, 120, 128, 140, 174)
KINDS = {
    "plain": {},
    "swing": {"swing": 0.62},
    "triplets": {"swing": 2 / 3},
    "faster by 8 %": {"drift": 0.08},
    "slower by 8 %": {"drift": -0.08},
    "noise at 0 dB": {"noise": True},
    "10 s silence": {"silence": 10.0},
}
"""What the music is like, by name."""
WINDOW, FROM = 0.07, 5.0
"""How far a beat may be off, and the time from which on beats count [s]."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=40.0, help="length of the pieces")
    parser.add_argument("--speed", action="store_true", help="how long four minutes take, alone")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "music.wav"
        if arguments.speed:
            print(speed(path))
            return
        print("F of beats and of downbeats" + "".join(f"{bpm:>13}" for bpm in TEMPOS))
        for is_band in (False, True):
            for name, given in KINDS.items():
                base = Piece(120, is_band, seconds=arguments.seconds, **given)
                row([replace(base, bpm=bpm) for bpm in TEMPOS], is_band, name, path)
        row([Piece(bpm, meter=3, seconds=arguments.seconds) for bpm in TEMPOS], True, "3/4", path)
        row([replace(p, noise=True) for p in in_three(arguments.seconds)], True, "3/4 noise", path)
        print("clicks between 80 and 160, heard tempo over true one:")
        print("  " + "  ".join(f"{bpm}: {octave(bpm, path):.2f}" for bpm in range(80, 161, 8)))


def in_three(seconds: float) -> Iterator[Piece]:
    """Waltzes of all tempos."""
    yield from (Piece(bpm, meter=3, seconds=seconds) for bpm in TEMPOS)


def row(pieces: list[Piece], is_band: bool, name: str, path: Path) -> None:
    """Print how well some pieces are heard."""
    cells = []
    for piece in pieces:
        played = play(piece)
        heard = heard_in(played, path, piece.meter)
        beats = f_measure(played.beats, heard.beats)
        bars = f_measure(played.downbeats, heard.downbeats)
        cells.append(f"  {beats:.3f} {bars:.3f}")
    print(f"{('band, ' if is_band else 'clicks, ') + name:<27}" + "".join(cells), flush=True)


def octave(bpm: float, path: Path) -> float:
    """The tempo that is heard in clicks, over the true one."""
    heard = heard_in(play(Piece(bpm, False, seconds=20)), path, 4)
    return (heard.bpm or 0.0) / bpm


def heard_in(played: Played, path: Path, meter: int) -> Heard:
    """What is heard in a file of a piece."""
    save(path, played.sound[None])
    return listen(path, meter=meter).heard


def save(path: Path, sound: np.ndarray) -> None:
    """Write samples, [channels, N], as a WAV of 16 bits."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(len(sound))
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes((np.clip(sound.T, -1, 1) * 32767).astype("<i2").tobytes())


def f_measure(true: np.ndarray, heard: np.ndarray) -> float:
    """The harmonic mean of the parts of true beats that are heard and of heard ones that are true.

    Args:
        true: Times of beats [s], ascending.
        heard: Times of those that were heard [s], ascending.
    """
    true, heard = true[true >= FROM], heard[heard >= FROM]
    hits, place = 0, 0
    for time in true:
        while place < len(heard) and heard[place] < time - WINDOW:
            place += 1
        if place < len(heard) and heard[place] <= time + WINDOW:
            hits, place = hits + 1, place + 1
    return 2 * hits / max(1, len(true) + len(heard))


def speed(path: Path) -> str:
    """How long four minutes of stereo take, and how much memory, in a process of their own."""
    mono = play(Piece(124, seconds=60.0)).sound
    save(path, np.tile(np.stack([mono, np.roll(mono, 30)]), 4)[:, : 240 * RATE])
    code = (
        "import resource, sys, time; from pathlib import Path; "
        "from stages.hearing.listening.listen import listen; begun = time.perf_counter(); "
        "busy = time.process_time(); listen(Path(sys.argv[1])); "
        "busy = time.process_time() - busy; took = time.perf_counter() - begun; "
        "most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024; "
        "print(f'four minutes of stereo: {took:.2f} s, CPU {busy:.2f} s, {most:.0f} MiB at most')"
    )
    made = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True)
    return made.stdout + made.stderr


if __name__ == "__main__":
    main()
