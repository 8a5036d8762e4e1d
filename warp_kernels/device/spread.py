"""Kernels that spread staged words over arrays of a card, and gather them from there."""

from typing import Any

import warp as wp

from warp_kernels.device.exact import EXACT

wp.set_module_options(EXACT)

WORD = 4
"""Bytes of what is moved."""
LANES = 256
"""Threads that share a piece."""
MOST_PIECES = 16
"""Pieces of a launch."""
ROW = 5
"""Numbers of a piece: address on the card, first word in the staging memory, rows, words of a row,
words from a row to the next on the card."""
Table: Any = wp.types.vector(length=MOST_PIECES * ROW, dtype=wp.int64)
"""The pieces of a launch, as an argument: it needs no copy of its own."""


@wp.func
def word_of(table: Table, thread: int, turn: int) -> wp.vec2l:
    """The word that a thread moves in a turn: its address on the card, and where it is staged.

    An address of 0 says that there is none.
    """
    row = wp.static(ROW) * (thread / wp.static(LANES))
    word = wp.int64(turn) * wp.int64(wp.static(LANES)) + wp.int64(thread % wp.static(LANES))
    width = table[row + 3]
    if word >= table[row + 2] * width:
        return wp.vec2l(wp.int64(0), wp.int64(0))
    place = word / width * table[row + 4] + word % width
    return wp.vec2l(table[row] + place * wp.int64(wp.static(WORD)), table[row + 1] + word)


@wp.kernel
def scatter(
    # In:
    staged: wp.array(dtype=int),
    # Out:
    places_out: Table,
):
    """Spread what was staged over the places that a table names; LANES threads for each."""
    turn = int(0)
    word = word_of(places_out, wp.tid(), turn)
    while word[0] != wp.int64(0):
        target = wp.array(ptr=wp.uint64(word[0]), shape=(1,), dtype=int)
        target[0] = staged[int(word[1])]
        turn += 1
        word = word_of(places_out, wp.tid(), turn)


@wp.kernel
def gather(
    # In:
    places: Table,
    # Out:
    staged_out: wp.array(dtype=int),
):
    """Collect what lies at the places that a table names; LANES threads for each."""
    turn = int(0)
    word = word_of(places, wp.tid(), turn)
    while word[0] != wp.int64(0):
        source = wp.array(ptr=wp.uint64(word[0]), shape=(1,), dtype=int)
        staged_out[int(word[1])] = source[0]
        turn += 1
        word = word_of(places, wp.tid(), turn)
