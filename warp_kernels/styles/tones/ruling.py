"""Parallel lines across a tile as a steady hand draws them, stroke by stroke.

Every length is in texels unless it says otherwise. Lines close on the tile's opposite sides, and a
stroke that leaves on one side comes in on the other, so that tiles join without a seam.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

SIDE = 512
"""Width and height of a tile."""
WAVER, UNEVEN, AIM = 0.05, 0.05, 0.04
"""How far a line wavers, lies off its even place, and is missed by a stroke [spacings], as
standard deviations."""
SLOWEST, FASTEST = 2, 14
"""Waves of the hand along a tile, from and to."""
LEAST_INK = 1 / 512
"""Fainter parts of a stroke are left out."""

Inking = tuple[np.ndarray, np.ndarray]
"""Numbers of texels and how much of their paper a stroke covers, 0 to 1; both [N]."""


@dataclass(frozen=True)
class Direction:
    """Where lines lead; two turns round the tile close them."""

    steep: bool
    """Whether they run down the tile, else across."""
    slope: float
    """Texels aside for each along: a multiple of 1/2."""

    @property
    def stretch(self) -> float:
        """Width of a line, measured straight across or down the tile, per real width."""
        return float(np.hypot(1.0, self.slope))


ACROSS = Direction(steep=False, slope=0.0)
"""Along the base edge of a triangle."""
RISING, FALLING = Direction(steep=True, slope=-0.5), Direction(steep=True, slope=0.5)
"""At 63.4 degrees to it: crossings that look like diamonds rather than like a grid."""
SLANTED = Direction(steep=False, slope=0.5)
"""At 26.6 degrees."""


@dataclass(frozen=True)
class Touch:
    """How a pen goes over lines."""

    width: float
    """Width of the strokes where they are pressed normally [spacings]."""
    pressure: float
    """Ink that they leave there, 0 to 1."""
    begin: float = 0.0
    """First of the lines that are drawn, as a part of all; every other one comes first."""
    end: float = 1.0
    """The last one."""


class Ruling:
    """Parallel lines at even distances that waver each in its own way.

    Args:
        rng: Source of chance.
        direction: Where they lead.
        spacing: Distance of neighbours, about.
        shift: How far all of them lie aside [spacings].
        uneven: How far each lies off its even place [spacings], a standard deviation.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        direction: Direction,
        spacing: float,
        shift: float = 0.0,
        uneven: float = UNEVEN,
    ) -> None:
        # lines at a slope meet the side again half a tile further on, so their number is even
        self.count = 2 * round(SIDE / (2.0 * spacing * direction.stretch))
        self.direction = direction
        self.step = SIDE / self.count
        places = np.arange(self.count) + shift + rng.normal(0.0, uneven, self.count)
        self.places = places * self.step
        self.wavering = WAVER * self.step * _wavering(rng, self.count)
        self.order = np.argsort([_mirrored(i) for i in range(self.count)], kind="stable")

    def strokes(
        self, rng: np.random.Generator, touch: Touch, tooth: np.ndarray | None
    ) -> Iterator[Inking]:
        """Draw the lines, each with two strokes that meet or leave a gap.

        Args:
            rng: Source of chance.
            touch: How.
            tooth: Roughness of the paper, 0 to 1: ink stays off what the pressure does not
                exceed; [SIDE * SIDE], None for smooth paper.
        """
        begin, end = (round(part * self.count) for part in (touch.begin, touch.end))
        chosen = np.roll(self.order[begin:end], rng.integers(max(1, end - begin)))
        lines = np.repeat(chosen, 2)
        starts = np.repeat(rng.random(len(chosen)), 2) + np.tile([0.0, 0.5], len(chosen))
        starts = ((starts + rng.normal(0.0, 0.02, len(lines))) * SIDE).astype(np.int64)
        lengths = rng.uniform(0.46, 0.60, (len(lines), 1)) * SIDE
        along = np.arange(int(lengths.max()) + 1, dtype=np.float32)
        part = (along / lengths).astype(np.float32)
        pressure = _pressure(rng, part, along)
        run = starts[:, None] + along.astype(np.int64)
        centres = self._centres(rng, lines, run, part)
        halves = 0.5 * touch.width * self.step * (0.3 + 0.7 * pressure) * (pressure > 0)
        dark = touch.pressure * (0.6 + 0.4 * pressure) * np.minimum(1.0, 4.0 * pressure)
        texels, covered = self._covered(run, centres, halves)
        ink = covered * np.minimum(1.0, dark)[..., None]
        if tooth is not None:
            ink = covered * np.clip((1.05 * dark[..., None] - tooth[texels]) / 0.35, 0.0, 1.0)
        kept = ink > LEAST_INK
        for stroke in range(len(lines)):
            yield texels[stroke][kept[stroke]], ink[stroke][kept[stroke]]

    def _centres(
        self, rng: np.random.Generator, lines: np.ndarray, run: np.ndarray, part: np.ndarray
    ) -> np.ndarray:
        """Where the middle of every stroke is aside, [strokes, run]."""
        middle = self.places[lines][:, None] + self.direction.slope * run
        middle += np.take_along_axis(self.wavering[lines], run % SIDE, axis=1)
        miss, turn = rng.normal(0.0, AIM * self.step, (2, len(lines), 1))
        return middle + miss + 2.0 * turn * (part - 0.5)

    def _covered(
        self, run: np.ndarray, centres: np.ndarray, halves: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Texels around every stroke and the part of each that lies in it, [strokes, run, K]."""
        reach = int(np.ceil(halves.max())) + 1
        aside = np.floor(centres).astype(np.int32)[..., None] + np.arange(-reach, reach + 1)
        upper = (centres + halves).astype(np.float32)[..., None]
        lower = (centres - halves).astype(np.float32)[..., None]
        covered = np.minimum(aside + np.float32(1), upper) - np.maximum(aside, lower)
        run = (run % SIDE)[..., None]
        aside %= SIDE
        texels = run * SIDE + aside if self.direction.steep else aside * SIDE + run
        return texels, np.clip(covered, 0.0, 1.0)


def _wavering(rng: np.random.Generator, count: int) -> np.ndarray:
    """A slow, closed wave for every line, of standard deviation 1, [count, SIDE] float32."""
    waves = np.arange(SLOWEST, FASTEST)
    phases = 2.0 * np.pi * np.outer(waves, np.arange(SIDE)) / SIDE
    amplitudes = rng.normal(size=(2, count, len(waves))) / waves**0.9
    total = amplitudes[0] @ np.sin(phases) + amplitudes[1] @ np.cos(phases)
    return (total / total.std()).astype(np.float32)


def _pressure(rng: np.random.Generator, part: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Pressure along strokes, about 1 in the middle and 0 past both ends, [strokes, run] float32.

    Args:
        rng: Source of chance.
        part: Part of the stroke that is drawn, 0 to 1, then more; [strokes, run].
        along: The same in texels, [run].
    """
    shape = (len(part), 1)
    swelling = np.ones((1, 1), dtype=np.float32)
    for wave in (20.0, 50.0, 110.0):
        turns = (2.0 * np.pi / wave) * along * rng.uniform(0.75, 1.35, shape)
        swelling = swelling + 0.12 * rng.normal(size=shape) * np.sin(
            (turns + rng.uniform(0.0, 2.0 * np.pi, shape)).astype(np.float32)
        )
    begin = np.clip(part / rng.uniform(0.06, 0.20, shape), 0.0, 1.0)
    end = np.clip((1.0 - part) / rng.uniform(0.10, 0.35, shape), 0.0, 1.0)
    tapered = np.sqrt(begin) * end * rng.uniform(0.85, 1.12, shape)
    return (tapered * np.clip(swelling, 0.3, 1.4)).astype(np.float32)


def _mirrored(number: int) -> float:
    """The binary digits of a number behind the point: 0, 1/2, 1/4, 3/4, 1/8, ...

    Source: van der Corput, Verteilungsfunktionen (1935).
    """
    return sum((number >> i & 1) / 2.0 ** (i + 1) for i in range(number.bit_length()))
