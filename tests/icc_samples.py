"""ICC profiles, written tag by tag."""

import struct

import numpy as np

SRGB = np.array(
    [
        [0.4360747, 0.3850649, 0.1430804],
        [0.2225045, 0.7168786, 0.0606169],
        [0.0139322, 0.0971045, 0.7141733],
    ]
)
"""Primaries as XYZ under a white of D50, one a column."""
DISPLAY_P3 = np.array(
    [
        [0.515102, 0.291965, 0.157153],
        [0.241182, 0.692236, 0.0665819],
        [-0.00104941, 0.0418818, 0.784378],
    ]
)


def gamma(value: float) -> bytes:
    """A power as a curve."""
    return b"curv" + bytes(4) + struct.pack(">IH", 1, round(value * 256))


def table(values: list[int]) -> bytes:
    """A curve by points."""
    return b"curv" + bytes(4) + struct.pack(f">I{len(values)}H", len(values), *values)


def formula(kind: int, *values: float) -> bytes:
    """A parametric curve."""
    numbers = [round(value * 65536) for value in values]
    return b"para" + bytes(4) + struct.pack(f">HH{len(values)}i", kind, 0, *numbers)


SRGB_CURVE = formula(3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)


def profile(
    primaries: np.ndarray | None,
    curve: bytes,
    space: bytes = b"RGB ",
    name: str = "made for a test",
) -> bytes:
    """A profile of three primaries and one curve for all, or of a grey curve.

    Args:
        primaries: XYZ of the primaries, one a column; None for a profile without any.
        curve: The curve.
        space: What the pictures are made of.
        name: Its description.
    """
    text = name.encode() + b"\0"
    tags = {
        b"desc": b"desc" + bytes(4) + struct.pack(">I", len(text)) + text + bytes(78),
        b"wtpt": _xyz((0.9642, 1.0, 0.8249)),
        b"cprt": b"text" + bytes(4) + b"none\0",
    }
    if space == b"GRAY":
        tags[b"kTRC"] = curve
    elif primaries is not None:
        for number, letter in enumerate((b"r", b"g", b"b")):
            tags[letter + b"XYZ"] = _xyz(primaries[:, number])
            tags[letter + b"TRC"] = curve
    listed, data = b"", b""
    begin = 132 + 12 * len(tags)
    for letters, content in tags.items():
        padded = content + bytes(-len(content) % 4)
        listed += struct.pack(">4sII", letters, begin + len(data), len(content))
        data += padded
    head = struct.pack(
        ">I4sI4s4s4s", begin + len(data), b"none", 0x02400000, b"mntr", space, b"XYZ "
    )
    head += struct.pack(">6H4s", 2026, 1, 1, 0, 0, 0, b"acsp") + bytes(28)
    head += struct.pack(">3i", 63190, 65536, 54061) + bytes(48)
    return head + struct.pack(">I", len(tags)) + listed + data


def _xyz(values: object) -> bytes:
    return b"XYZ " + bytes(4) + struct.pack(">3i", *(round(float(v) * 65536) for v in values))
