"""The verbs of the formulas, interpreted: on numpy float64 and on arrays of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes.vec import Number, Vec

WIDTH = 8  # rays that a kernel traces at once: one AVX-512 register of float64, two of AVX2
Mask = Any  # a numpy bool, an array of them, or a mask of the processor


def where(mask: Mask, a: Any, b: Any) -> Any:
    """For each ray `a` where the mask is true and `b` where it is not; of two Vecs, each component so."""
    if isinstance(a, Vec):
        return Vec(where(mask, a.x, b.x), where(mask, a.y, b.y), where(mask, a.z, b.z))
    return np.where(mask, a, b)[()]


def any(mask: Mask) -> bool:
    """True if the mask is true for at least one ray."""
    return bool(np.any(mask))


def sqrt(x: Number) -> Number:
    """The square root, NaN below 0."""
    return np.sqrt(x)


def fabs(x: Number) -> Number:
    """The absolute value."""
    return np.fabs(x)


def floor(x: Number) -> Number:
    """The greatest whole number not above x."""
    return np.floor(x)


def copysign(x: Number, sign: Number) -> Number:
    """The absolute value of x with the sign of `sign`."""
    return np.copysign(x, sign)


def rounded_product(a: Number, b: Number) -> Number:
    """a * b, rounded here and not together with what follows."""
    return a * b


def product_error(a: Number, b: Number) -> Number:
    """What rounding drops from a * b, exactly; the numbers must be between 1e-140 and 1e140."""
    a_high, b_high = high_half(a), high_half(b)
    a_low, b_low = a - a_high, b - b_high
    return a_low * b_low - (((a * b - a_high * b_high) - a_low * b_high) - a_high * b_low)


def high_half(x: Number) -> Number:
    """x to 26 of its 53 bits (Veltkamp), so that products of halves are exact."""
    shifted = x * (2.0**27 + 1.0)
    return shifted - (shifted - x)


def minimum(a: Number, b: Number) -> Number:
    """The lesser; b where one of the two is NaN."""
    return where(a < b, a, b)


def maximum(a: Number, b: Number) -> Number:
    """The greater; b where one of the two is NaN."""
    return where(a > b, a, b)


def splat(x: float) -> Number:
    """The same number for each of `WIDTH` rays."""
    return np.full(WIDTH, x)


def load(values: Any, start: int) -> Number:
    """`WIDTH` numbers of an array from index `start` on."""
    return values[start : start + WIDTH].copy()


def lane(x: Number, ray: int) -> float:
    """The number of one ray."""
    return float(x[ray])


def first(mask: Mask) -> int:
    """The index of the first ray for which the mask is true; there must be one."""
    return int(np.argmax(mask))
