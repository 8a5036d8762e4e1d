"""Colour models as tables: which monomials a triangle's colour has, and which moments follow.

A colour model of degree d approximates each channel by a polynomial in x and y. Everything that
the kernels need is derived from its exponents. Moments come in two groups:

* area moments, sum of x^a y^b for a + b <= 2 d: the matrix of Eq. 15; the first is the count;
* colour moments, one 4-vector per term (a, b): the sums of x^a y^b I for red, green and blue,
  the right-hand sides of Eq. 15. The fourth component of the first term holds the sum of I^2
  over the channels; that of every other term is unused and lets a processor add four at once.

Where pixels have weights, every sum has the pixel's weight as a factor and the count becomes the
sum of the weights. Coordinates in moments count from the middle of the image, which keeps the sums
small. How the sums are kept is told by `moment_layout`.
"""

from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class ColorModel:
    """A polynomial colour per triangle.

    Source: Lawonn & Guenther (2018), Eqs. 2-3 (models), Eqs. 14-15 (moments).
    Deviation: the paper has no quadratic colours; its Eq. 15 with three more terms gives them.
    """

    name: str
    """The name on the command line."""
    degree: int
    """Total degree of the polynomial."""

    @cached_property
    def exponents(self) -> tuple[tuple[int, int], ...]:
        """Powers (a, b) of x^a y^b of every term, the constant first, then by total degree."""
        return _monomials(self.degree)

    @cached_property
    def area_exponents(self) -> tuple[tuple[int, int], ...]:
        """Powers of the moments of the covered area itself: those of a product of two terms."""
        return _monomials(2 * self.degree)

    @property
    def term_count(self) -> int:
        """Number K of coefficients per channel."""
        return len(self.exponents)

    @property
    def area_count(self) -> int:
        """Number of moments that depend on the covered area alone; the first is the count."""
        return len(self.area_exponents)

    def term(self, a: int, b: int) -> int:
        """Index of the term x^a y^b."""
        return self.exponents.index((a, b))

    def area_moment(self, a: int, b: int) -> int:
        """Index of the moment sum of x^a y^b."""
        return self.area_exponents.index((a, b))


def _monomials(degree: int) -> tuple[tuple[int, int], ...]:
    """All (a, b) with a + b <= degree, ordered by total degree, then by falling a."""
    return tuple((total - b, b) for total in range(degree + 1) for b in range(total + 1))


CHANNELS = 3
SQUARE = 3
"""Component of the first term's 4-vector that holds the sum of I^2."""

CONSTANT = ColorModel("constant", degree=0)
LINEAR = ColorModel("linear", degree=1)
QUADRATIC = ColorModel("quadratic", degree=2)

COLOR_MODELS = {model.name: model for model in (CONSTANT, LINEAR, QUADRATIC)}
