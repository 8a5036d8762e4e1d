"""Logarithms, powers and angles whose bits are the same on every device.

The C library and CUDA's round these functions otherwise than each other. Here they are made of
additions, multiplications, divisions, roots and whole numbers, which every device rounds alike.
They are computed in float64 by polynomials of the least relative error, and rounded once, so that
they are within 0.6 units of the last place of float32.
"""

import math

import warp as wp

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

_LN2 = wp.constant(wp.float64(math.log(2.0)))
_TWO_PER_E = wp.constant(wp.float64(1.0 / math.log(2.0)))
_ONE = wp.constant(wp.float64(1.0))
_HALF = wp.constant(wp.float64(0.5))
_FRACTION = wp.constant(wp.int64(52))
"""Bits of the fraction of a number in float64."""
_ROOT_HALF = wp.constant(wp.int64(0x3FE6A09E667F3BCD))
"""The bits of sqrt(1/2): exponents are told from fractions so that these lie around 1."""
_WHOLE = wp.constant(wp.float64(1.5 * 2.0**52))
"""What is added to it is rounded to a whole number, which the last bits of the sum are."""
_BIAS = wp.constant(wp.int64(1023))
"""The exponent of 1 in float64."""


@wp.func
def _parted_log(x: wp.float64) -> wp.vec2d:
    """The exponent of 2, and the natural logarithm of the fraction from sqrt(1/2) to sqrt(2).

    ln m = 2 artanh(s) with s = (m - 1) / (m + 1); artanh(s) / s as a polynomial of s^2 is off by
    7e-10 at most.
    """
    bits = wp.cast(x, wp.int64)
    exponent = (bits - _ROOT_HALF) >> _FRACTION
    m = wp.cast(bits - (exponent << _FRACTION), wp.float64)
    s = (m - _ONE) / (m + _ONE)
    q = s * s
    low = wp.static(wp.float64(0.9999999993104215)) + wp.static(wp.float64(0.3333340799756662)) * q
    high = wp.static(wp.float64(0.1998739490485051)) + wp.static(wp.float64(0.1496289544115462)) * q
    return wp.vec2d(wp.float64(exponent), (s + s) * (low + q * q * high))


@wp.func
def natural_log(x: float) -> float:
    """Natural logarithm; x is above 0."""
    parts = _parted_log(wp.float64(x))
    return float(parts[0] * _LN2 + parts[1])


@wp.func
def binary_log(x: float) -> float:
    """Logarithm to the base 2, exact for powers of 2; x is above 0."""
    parts = _parted_log(wp.float64(x))
    return float(parts[0] + parts[1] * _TWO_PER_E)


@wp.func
def exponential(x: float) -> float:
    """The exponential function: 0 and infinity where float32 ends.

    Near 0 as a polynomial that is off by 2e-9 at most.
    """
    inside = wp.float64(wp.clamp(x, -110.0, 90.0))
    shifted = inside * _TWO_PER_E + _WHOLE
    r = inside - (shifted - _WHOLE) * _LN2
    q = r * r
    first = wp.static(wp.float64(1.0000000005546177)) + wp.static(wp.float64(1.000000036345269)) * r
    then = wp.static(wp.float64(0.499999920749785)) + wp.static(wp.float64(0.16666420069645474)) * r
    high = wp.static(wp.float64(0.04166822620177538))
    high += wp.static(wp.float64(0.008374824257823925)) * r
    high += wp.static(wp.float64(0.0013836835728640007)) * q
    doubled = (wp.cast(shifted, wp.int64) + _BIAS) << _FRACTION
    return float((first + q * (then + q * high)) * wp.cast(doubled, wp.float64))


@wp.func
def power_of_90(x: float) -> float:
    """x to the power of 90, by products alone."""
    x1 = wp.float64(x)
    x2 = x1 * x1
    x4 = x2 * x2
    x8 = x4 * x4
    x16 = x8 * x8
    x32 = x16 * x16
    return float((x32 * x32) * (x16 * (x8 * x2)))


@wp.func
def half_angle(x: float, y: float) -> wp.vec2f:
    """Cosine and sine of half the angle of the vector (x, y), without the angle.

    The half angle is between -90 and 90 degrees; that of the vector 0 is 0. Of the two formulae for
    each the one without a difference of near numbers is taken.
    """
    across = wp.float64(x)
    up = wp.float64(y)
    length = wp.sqrt(across * across + up * up)
    if length == wp.static(wp.float64(0.0)):
        return wp.vec2f(1.0, 0.0)
    larger = wp.sqrt(_HALF + _HALF * wp.abs(across) / length)
    smaller = _HALF * wp.abs(up) / (length * larger)
    side = wp.where(y < 0.0, -_ONE, _ONE)
    if x >= 0.0:
        return wp.vec2f(float(larger), float(side * smaller))
    return wp.vec2f(float(smaller), float(side * larger))
