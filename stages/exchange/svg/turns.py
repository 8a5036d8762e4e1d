"""Frames that are shown in turn, without a script: programs that do not animate show the first.

Source: W3C, SVG Animations Level 2: `animate` with discrete values.
"""

from collections.abc import Iterator
from fractions import Fraction

from stages.exchange.film import Film

MOST = 16_000_000
"""Characters of an animated document: browsers draw larger ones in jerks, or not at all."""
STILL = Fraction(1, 25)
"""How long a frame is shown of which nothing tells how long [s]."""


def turns(times: list[Fraction], rate: Fraction | None) -> Iterator[str]:
    """Elements that show one frame after the other, again and again.

    Args:
        times: When each is shown [s], ascending.
        rate: Frames per second, if known: that is how long the last one is shown.
    """
    steps = len(times) - 1
    last = (times[-1] - times[0]) / steps if steps else STILL
    if rate:
        last = min(1 / rate, last) if steps else 1 / rate
    ends = [*times[1:], times[-1] + (last or STILL)]
    whole = ends[-1] - times[0]
    for begin, end in zip(times, ends, strict=True):
        keys = [("none", 0.0)] if begin > times[0] else []
        keys.append(("inline", float((begin - times[0]) / whole)))
        if end < ends[-1]:
            keys.append(("none", float((end - times[0]) / whole)))
        values, places = ";".join(key for key, _ in keys), ";".join(f"{at:.9g}" for _, at in keys)
        yield (
            f'<animate attributeName="display" calcMode="discrete" values="{values}" '
            f'keyTimes="{places}" dur="{float(whole):.9g}s" repeatCount="indefinite"/>'
        )


def too_large(film: Film, written: int, frames: int) -> str | None:
    """What is told of a document that would become too large, or None.

    Args:
        film: Tells how many frames there will be, if that is known.
        written: Characters so far.
        frames: Frames so far.
    """
    expected = max(film.frames or 0, frames)
    size = written * expected // frames
    if size <= MOST:
        return None
    return (
        f"{film.ending}: {expected} frames make {size / 1e6:.0f} MB, and an animated one holds at "
        f"most {MOST / 1e6:.0f}; take fewer --triangles or --frames, such as A-Bx2, "
        f"--svg-precision 1, numbered files (name_####{film.ending}), or .mp4"
    )
