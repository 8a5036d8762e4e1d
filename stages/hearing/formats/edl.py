"""Sections from an edit decision list, CMX 3600, as editing programs export cuts and markers.

Times count frames, and the list does not say how many there are in a second.
"""

import re
from fractions import Fraction

from stages.hearing.heard import Heard, Mark

_EVENT = re.compile(
    r"\s*\d{1,6}\s+\S+\s+\S+\s+[A-Z]\S*(?:\s+\d+)?"
    r"\s+([\d:;.]{11})\s+([\d:;.]{11})\s+([\d:;.]{11})\s+([\d:;.]{11})"
)
_CODE = re.compile(r"(\d\d)[:;.](\d\d)[:;.](\d\d)([:;.])(\d\d)")
_NAME = re.compile(r"\*\s*(?:FROM|TO) CLIP NAME:\s*(.*\S)|.*\|M:([^|]*[^|\s])")
_LOCATOR = re.compile(r"\*\s*LOC:\s*([\d:;.]{11})\s+(\S+)\s*(.*)")


def from_edl(text: str, rate: Fraction | None = None) -> Heard:
    """Read where sections begin; they are named after clips, markers and locators.

    Args:
        text: The file.
        rate: Frames a second of the film; None for 29.97 with drop-frame times, else 25.

    Raises:
        ValueError: If it holds no event, or a time that there is not; the message says in which
            line.
    """
    drops = "FCM: DROP" in text.upper()
    rate = rate or (Fraction(30000, 1001) if drops else Fraction(25))
    begins: list[int] = []
    names: list[str] = []
    end, zero = 0, None
    for number, line in enumerate(text.split("\n"), start=1):
        event, locator, named = _EVENT.match(line), _LOCATOR.match(line), _NAME.match(line)
        if event or locator:
            code = event[3] if event else locator[1] if locator else ""
            begins.append(_frame(code, number, rate, drops))
            names.append((locator[3] or locator[2]) if locator else "")
            if zero is None:  # films begin at 01:00:00:00
                zero = _frame(f"{code[:2]}:00:00:00", number, rate, drops)
        elif named and names and not names[-1]:
            names[-1] = named[1] or named[2]
        if event:
            end = max(end, _frame(event[4], number, rate, drops))
    if zero is None:
        raise ValueError("holds no event")
    marks = sorted(dict(zip(begins, names, strict=True)).items())
    sections = tuple(
        Mark(float(max(frame - zero, 0) / rate), name or f"section {number}")
        for number, (frame, name) in enumerate(marks, start=1)
    )
    return Heard(float(max(end - zero, 0) / rate), sections=sections)


def _frame(code: str, line: int, rate: Fraction, drops: bool) -> int:
    """The number of a frame; drop-frame times leave two a minute out, but for every tenth."""
    match = _CODE.fullmatch(code)
    base = round(rate)
    if match is None or int(match[5]) >= base or int(match[2]) > 59 or int(match[3]) > 59:
        raise ValueError(f"line {line}: {code!r} is no time of {base} frames a second")
    minutes = int(match[1]) * 60 + int(match[2])
    frame = (minutes * 60 + int(match[3])) * base + int(match[5])
    if (drops or match[4] == ";") and base % 30 == 0:
        frame -= base // 15 * (minutes - minutes // 10)
    return frame
