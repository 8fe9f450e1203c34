"""Powers, which a highlight takes, of the verbs of the formulas: in place of a library's, which knows no lanes."""

from __future__ import annotations

from minirt.lanes.operations import exponent, floor, maximum, two_to, where
from minirt.lanes.vec import Number

ROOT = 2.0**0.5
LOWEST = -1100.0  # 2 to that is 0


def power(x: Number, n: Number) -> Number:
    """x^n for x in [0, 1] and n >= 1, by way of n log2(x).

    In float64 its relative error is below 1e-15 + 6e-16 n |ln x|; the second part is what two roundings of n ln x do.
    """
    return exp2(maximum(n * log2(x), LOWEST))


def log2(x: Number) -> Number:
    """The logarithm to base 2 of a positive number: that of its power of 2, and 2 artanh(s) / ln 2 of what is left,
    m = (1 + s) / (1 - s) in [sqrt(1/2), sqrt(2)], as a series in s; for 0 some number below -126."""
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
    """2^y for y <= 0 and not below `LOWEST`: the power of the nearest whole number, and Taylor's series of the rest."""
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
