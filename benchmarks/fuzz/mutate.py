"""Damage to bytes and to texts, chosen by a seed."""

import random
import string
from collections.abc import Callable, Sequence

EXTREMES = (
    0,
    1,
    2,
    0x7F,
    0x80,
    0xFF,
    0x7FFF,
    0xFFFF,
    0x7FFFFFFF,
    0xFFFFFFFF,
    1 << 63,
    (1 << 64) - 1,
)
"""Numbers at which programs go wrong."""
WORDS = ("nan", "-1", "1e999", "0", "99999999999999999999", "''", "[]", "{}", "true", "\\x1b[2J")
"""What is put where a value stood."""
MOST = 12
"""Most changes of one mutant."""


def mutant(content: bytes, others: Sequence[bytes], chance: random.Random) -> bytes:
    """Bytes with some damage.

    Args:
        content: What is damaged.
        others: What pieces of others are taken from.
        chance: Chooses the damage.
    """
    broken = bytearray(content)
    for _ in range(chance.choice((1, 1, 1, 2, 4, MOST))):
        chance.choice(DAMAGES)(broken, others, chance)
        if not broken:
            return b""
    return bytes(broken)


def broken_text(text: str, chance: random.Random) -> str:
    """A text with some damage.

    Args:
        text: What is damaged.
        chance: Chooses the damage.
    """
    for _ in range(chance.choice((1, 1, 2, 3))):
        at = chance.randrange(len(text) + 1)
        to = min(len(text), at + chance.randrange(1, 12))
        put = chance.choice(
            (
                chance.choice(WORDS),
                "".join(chance.choices(string.printable, k=chance.randrange(1, 6))),
                "",
                text[at:to] * chance.choice((2, 50, 4000)),
                "\\0",
                "[" * 2000,
            )
        )
        text = text[:at] + put + text[to:]
    return text


def _flip(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    """Single bits, near the beginning more often than elsewhere: there stand the headers."""
    for _ in range(chance.choice((1, 3, 10, 60))):
        content[_place(content, chance)] ^= 1 << chance.randrange(8)


def _number(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    """A number of some width, in either order of bytes."""
    width = chance.choice((1, 2, 4, 8))
    value = chance.choice(EXTREMES) & ((1 << 8 * width) - 1)
    at = _place(content, chance)
    content[at : at + width] = value.to_bytes(width, chance.choice(("big", "little")))


def _cut(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    del content[chance.randrange(len(content)) :]


def _drop(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    at = _place(content, chance)
    del content[at : at + chance.choice((1, 4, 16, 200))]


def _repeat(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    at = _place(content, chance)
    piece = content[at : at + chance.choice((8, 64, 500))]
    content[at:at] = piece * chance.choice((1, 2, 40))


def _blank(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    at = _place(content, chance)
    size = min(chance.choice((4, 32, 400)), len(content) - at)
    content[at : at + size] = bytes([chance.choice((0, 255, 65))]) * size


def _graft(content: bytearray, others: Sequence[bytes], chance: random.Random) -> None:
    """A piece of another file in place of as much of this one."""
    other = chance.choice(others)
    at, start = _place(content, chance), chance.randrange(len(other))
    size = min(chance.choice((4, 40, 600)), len(content) - at)
    content[at : at + size] = other[start : start + size]


DAMAGES: tuple[Callable[[bytearray, Sequence[bytes], random.Random], None], ...] = (
    *(_flip, _flip, _number, _number),
    *(_cut, _drop, _repeat, _blank, _graft),
)
"""What is done, often ones several times."""


def _place(content: bytearray, chance: random.Random) -> int:
    if chance.random() < 0.5:
        return chance.randrange(min(len(content), 300))
    return chance.randrange(len(content))
