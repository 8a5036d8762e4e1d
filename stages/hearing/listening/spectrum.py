"""Spectra of a sound over time, made piece by piece so that little of it is held."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.fft import rfft

RATE = 24000
"""Samples a second that are listened to; nothing above 12 kHz tells of beats."""
HOP = 240
"""Samples from one spectrum to the next."""
FRAMES = RATE / HOP
"""Spectra a second."""
STEP = 60
"""Samples over which power is summed where moments count: 2.5 ms."""
STEPS = RATE / STEP
"""Such steps a second."""
SIZE = 1024
"""Samples of a spectrum: 43 ms."""
LONG_SIZE, LONG_HOP = 8192, 2400
"""Samples of the spectra in which tones are told apart, and from one to the next."""
LOWEST, HIGHEST, BANDS = 30.0, 11000.0, 48
"""Bounds of the bands [Hz], which are even in pitch, and how many there are at most."""
TONES = np.arange(28, 96)
"""Tones from E1 to B6 in the numbers of MIDI."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A sound in bands; row k is centred at the time k / FRAMES."""

    bands: np.ndarray
    """Magnitudes, [N, B] float32."""
    centers: np.ndarray
    """Middles of the bands [Hz], [B]."""
    rms: np.ndarray
    """Root mean squares of the samples, [N] float32."""
    peak: np.ndarray
    """Largest samples around, [N] float32."""
    centroid: np.ndarray
    """Middle of the spectrum [Hz], [N] float32; 0 in silence."""
    tones: np.ndarray
    """Magnitudes of the tones, [M, T] float32; row k is centred at k * LONG_HOP / RATE."""
    powers: np.ndarray
    """Mean squares of the samples, and of how they change, [P, 2] float32; row k is from k / STEPS
    to (k + 1) / STEPS."""
    duration: float
    """How long the sound is [s]."""


def spectrum_of(pieces: Iterable[np.ndarray]) -> Spectrum:
    """Take a sound apart.

    Bands are sums in a fixed order, so the result does not depend on the number of threads.

    Args:
        pieces: One channel of samples at `RATE`, [1, N] float32 each.
    """
    edges = band_edges()
    short, long = _Windows(SIZE, HOP), _Windows(LONG_SIZE, LONG_HOP)
    rows: list[tuple[np.ndarray, ...]] = []
    tones: list[np.ndarray] = []
    powers: list[np.ndarray] = []
    rest = np.zeros(1, np.float32)
    count = 0
    for samples in _joined(pieces):
        count += len(samples)
        rest = np.concatenate([rest, samples])
        powers.append(_powers_of(rest))
        rest = rest[len(powers[-1]) * STEP :]
        rows += [_row_of(windows, edges) for windows in short.add(samples)]
        tones += [_tones_of(windows) for windows in long.add(samples)]
    rows += [_row_of(windows, edges) for windows in short.finish()]
    tones += [_tones_of(windows) for windows in long.finish()]
    bands, rms, peak, centroid = (np.concatenate(part) for part in zip(*rows, strict=True))
    middles = np.sqrt(edges[:-1] * np.maximum(edges[:-1], edges[1:] - 1)) * (RATE / SIZE)
    powers.append(_powers_of(np.pad(rest, (0, STEP))))
    return Spectrum(
        bands,
        middles,
        rms,
        peak,
        centroid,
        np.concatenate(tones),
        np.concatenate(powers),
        count / RATE,
    )


def _joined(pieces: Iterable[np.ndarray]) -> Iterator[np.ndarray]:
    """Pieces of a second at least, [N] each: decoders give many short ones."""
    held: list[np.ndarray] = []
    for piece in pieces:
        held.append(np.asarray(piece[0], np.float32))
        if sum(map(len, held)) >= RATE:
            yield np.concatenate(held)
            held = []
    if held:
        yield np.concatenate(held)


def band_edges() -> np.ndarray:
    """First bins of the bands and the end of the last one, [B + 1] int; no band is empty."""
    pitches = np.geomspace(LOWEST, HIGHEST, BANDS + 1) * SIZE / RATE
    return np.unique(np.maximum(1, pitches.round().astype(int)))


class _Windows:
    """Cuts pieces into windows that overlap; the first one is centred at the time 0."""

    def __init__(self, size: int, hop: int) -> None:
        self._size, self._hop = size, hop
        self._left = np.zeros(size // 2, np.float32)
        self._taper = np.hanning(size + 1)[:-1].astype(np.float32)
        self._most = 1 << 20

    def add(self, samples: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Windows that are complete, as they are and tapered, [N, size] each."""
        joined = np.concatenate([self._left, samples])
        count = max(0, (len(joined) - self._size) // self._hop + 1)
        self._left = joined[count * self._hop :].copy()
        if not count:
            return
        step = max(1, self._most // self._size)
        views = np.lib.stride_tricks.sliding_window_view(joined, self._size)[:: self._hop]
        for start in range(0, count, step):
            plain = views[start : min(start + step, count)]
            yield plain, plain * self._taper

    def finish(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The windows in which the sound ends."""
        yield from self.add(np.zeros(self._size // 2 + self._hop, np.float32))


def _row_of(windows: tuple[np.ndarray, np.ndarray], edges: np.ndarray) -> tuple[np.ndarray, ...]:
    """Bands, root mean squares, peaks and centroids of some windows."""
    plain, tapered = windows
    size = np.abs(rfft(tapered, axis=1)).astype(np.float32)
    bands = np.add.reduceat(size[:, : edges[-1]], edges[:-1], axis=1)
    middle = plain[:, (SIZE - 2 * HOP) // 2 : (SIZE + 2 * HOP) // 2]
    rms = np.sqrt(np.square(middle).mean(axis=1))
    total = size.sum(axis=1)
    pitch = np.arange(size.shape[1], dtype=np.float32) * np.float32(RATE / SIZE)
    centroid = (size * pitch).sum(axis=1) / np.maximum(total, 1e-6)
    peak = np.abs(middle).max(axis=1)
    return bands, rms, peak, np.where(total > 1e-4, centroid, 0).astype(np.float32)


def _powers_of(samples: np.ndarray) -> np.ndarray:
    """Mean squares of whole steps and of how they change; the first sample is the one before."""
    whole = (len(samples) - 1) // STEP * STEP
    both = np.stack([samples[1 : whole + 1], np.diff(samples[: whole + 1])], axis=1)
    return np.square(both).reshape(-1, STEP, 2).mean(axis=1)


def _tones_of(windows: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Magnitudes of tones in some windows: the largest within a quarter tone."""
    size = np.abs(rfft(windows[1], axis=1)).astype(np.float32)
    pitches = 440.0 * 2.0 ** ((np.append(TONES, TONES[-1] + 1) - 69.5) / 12) * LONG_SIZE / RATE
    edges = np.ceil(pitches).astype(int)
    return np.maximum.reduceat(size[:, : edges[-1]], edges[:-1], axis=1)
