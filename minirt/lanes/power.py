"""Powers on SIMD lanes, for specular highlights: the pow of a library takes no lanes."""

from __future__ import annotations

from minirt.lanes.operations import exponent, floor, maximum, two_to, where
from minirt.lanes.vec import Number

ROOT = 2.0**0.5
LOWEST = -1100.0  # 2^LOWEST is 0


def power(x: Number, n: Number) -> Number:
    """Return x^n = 2^(n log2(x)) for x in [0, 1] and n >= 1.

    In float64 its relative error is below 1e-15 + 6e-16 n |ln x|; the second term is from two roundings of n ln x.
    """
    return exp2(maximum(n * log2(x), LOWEST))


def log2(x: Number) -> Number:
    """Return the logarithm to base 2 of a positive number; for 0 a number below -126.

    It is the exponent of x plus log2(m) = 2 artanh(s) / ln 2, a series in s, where the mantissa m = (1 + s) / (1 - s)
    is in [sqrt(1/2), sqrt(2)].
    """
    whole = exponent(x)
    m = x * two_to(-whole)
    upper = m > ROOT
    m = where(upper, 0.5 * m, m)
    whole = where(upper, whole + 1.0, whole)
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = 1.0 / 23.0
    series = series * z + 1.0 / 21.0
    series = series * z + 1.0 / 19.0
    series = series * z + 1.0 / 17.0
    series = series * z + 1.0 / 15.0
    series = series * z + 1.0 / 13.0
    series = series * z + 1.0 / 11.0
    series = series * z + 1.0 / 9.0
    series = series * z + 1.0 / 7.0
    series = series * z + 1.0 / 5.0
    series = series * z + 1.0 / 3.0
    series = series * z + 1.0
    return whole + 2.885390081777926815 * s * series


def exp2(y: Number) -> Number:
    """Return 2^y for y in [`LOWEST`, 0]: 2 to the nearest whole number, times the Taylor series of the remainder."""
    whole = floor(y + 0.5)
    x = 0.693147180559945309 * (y - whole)
    series = 1.0 + x / 14.0
    series = 1.0 + x / 13.0 * series
    series = 1.0 + x / 12.0 * series
    series = 1.0 + x / 11.0 * series
    series = 1.0 + x / 10.0 * series
    series = 1.0 + x / 9.0 * series
    series = 1.0 + x / 8.0 * series
    series = 1.0 + x / 7.0 * series
    series = 1.0 + x / 6.0 * series
    series = 1.0 + x / 5.0 * series
    series = 1.0 + x / 4.0 * series
    series = 1.0 + x / 3.0 * series
    series = 1.0 + x / 2.0 * series
    series = 1.0 + x * series
    return series * two_to(whole)
