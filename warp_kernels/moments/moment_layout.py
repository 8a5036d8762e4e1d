"""How the moments of a colour model are kept: in which integers, and where in the prefix table.

There are two layouts. The narrow one is that of pixels without weights and of at most linear
colours: the table holds int32 and nothing but colours, area moments follow from columns in closed
form, and no sum can leave its integers (see `check_size`).

The wide one is for everything else. Its table holds 64-bit integers, and beside the colours the
sums of w x^a themselves: a weight has no closed form. The powers of a large picture leave 64 bits;
so the wide layout counts modulo 2^64, in unsigned integers, for which that is defined. Sums,
differences, products and moves to another origin are exact nevertheless as soon as what they lead
to is below 2^63: the moments of a triangle seen from its own middle are, see `fit`.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import warp as wp

from warp_kernels.color_model import ColorModel

ENTRY = 4
"""Integers per entry of the table."""


@dataclass(frozen=True)
class MomentLayout:
    """Where the sums of one colour model are kept."""

    model: ColorModel
    """Fixes the moments."""
    wide: bool
    """Whether sums are 64-bit integers that wrap around, and areas come from the table too."""

    @cached_property
    def depth(self) -> int:
        """Entries of the table per pixel.

        One per power of x from 0 to the degree d, and in the wide layout one more: of the
        2 d + 1 powers of the area the colours' unused fourth components hold d.
        """
        return self.model.degree + (2 if self.wide else 1)

    @cached_property
    def area_words(self) -> tuple[int, ...]:
        """Where in a pixel's entries the wide layout keeps the sums of w x^a, a from 0 to 2 d.

        The first four follow each other in the last entry, so that one instruction adds them.
        """
        degree = self.model.degree
        last = tuple(ENTRY * (degree + 1) + n for n in range(ENTRY))
        unused = tuple(ENTRY * power + ENTRY - 1 for power in range(1, degree + 1))
        return (last + unused)[: 2 * degree + 1]

    @property
    def word_bytes(self) -> int:
        """Size of one integer of the table."""
        return 8 if self.wide else 4


def layout_of_moments(model: ColorModel, *, weighted: bool = False) -> MomentLayout:
    """The layout in which the sums of a model are kept, over pixels with or without weights."""
    return MomentLayout(model, wide=weighted or model.degree > 1)


@dataclass(frozen=True)
class MomentTypes:
    """The Warp types of one layout's sums."""

    integer: Any
    """The type of one sum: int64, or uint64 where sums may wrap around."""
    word: Any
    """One integer of the prefix table."""
    entry: Any
    """Vector of 4 of them: one power of x for red, green and blue, and I^2 or an area."""
    color: Any
    """Vector of 4 K sums: for each term those for red, green, blue, and I^2 or nothing."""
    area: Any
    """Vector of G sums of x^a y^b."""


@cache
def moment_types(layout: MomentLayout) -> MomentTypes:
    """The types in which the sums of a layout are kept."""
    model = layout.model
    integer, word = (wp.uint64, wp.uint64) if layout.wide else (wp.int64, wp.int32)
    return MomentTypes(
        integer=integer,
        word=word,
        entry=wp.types.vector(length=ENTRY, dtype=word),
        color=wp.types.vector(length=4 * model.term_count, dtype=integer),
        area=wp.types.vector(length=model.area_count, dtype=integer),
    )
