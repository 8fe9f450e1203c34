"""The verbs of the formulas, interpreted: on numpy float64 and on arrays of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes.vec import Number, Vec, dot

BYTES = 128  # of the lanes of a number: 16 float64 or 32 float32
Mask = Any  # a numpy bool, an array of them, or a mask of the processor


def where(mask: Mask, a: Any, b: Any) -> Any:
    """For each ray `a` where the mask is true and `b` where it is not; of two Vecs, each component so."""
    if isinstance(a, Vec):
        return Vec(where(mask, a.x, b.x), where(mask, a.y, b.y), where(mask, a.z, b.z))
    return np.where(mask, a, b)[()]


def any(mask: Mask) -> bool:
    """True if the mask is true for at least one ray."""
    return bool(np.any(mask))


def rarely(mask: Mask) -> bool:
    """`any`, where that is not expected: what follows if it is so may be slow."""
    return any(mask)


def sqrt(x: Number) -> Number:
    """The square root, NaN below 0."""
    return np.sqrt(x)


def inverse_root(x: Number) -> Number:
    """1 / sqrt(x) for a positive normal number; compiled, the last two bits may be others."""
    return 1.0 / np.sqrt(x)


def unit(v: Vec) -> Vec:
    """The vector of length 1 in the direction of v."""
    return v * inverse_root(dot(v, v))


def unit_roundoff(x: Number) -> float:
    """The largest relative error of rounding to the precision of x: 2^-53, or 2^-24 for float32."""
    return float(np.finfo(np.asarray(x).dtype).eps) / 2


def fabs(x: Number) -> Number:
    """The absolute value."""
    return np.fabs(x)


def floor(x: Number) -> Number:
    """The greatest whole number not above x."""
    return np.floor(x)


def exponent(x: Number) -> Number:
    """The greatest whole number e with 2^e <= x, for x >= 0; for 0 and denormal numbers the one below all others."""
    least = np.finfo(np.asarray(x).dtype).minexp
    return np.maximum(np.where(x > 0.0, np.frexp(x)[1] - 1, least - 1), least - 1).astype(np.asarray(x).dtype)[()]


def two_to(x: Number) -> Number:
    """2^x for whole numbers x up to the largest `exponent`; 0 where that is less than the least normal number."""
    kind = np.asarray(x).dtype
    return np.where(x < np.finfo(kind).minexp, 0.0, np.ldexp(kind.type(1), np.asarray(x).astype(int))).astype(kind)[()]


def copysign(x: Number, sign: Number) -> Number:
    """The absolute value of x with the sign of `sign`."""
    return np.copysign(x, sign)


def rounded_product(a: Number, b: Number) -> Number:
    """a * b, rounded here and not together with what follows."""
    return a * b


def product_error(a: Number, b: Number) -> Number:
    """What rounding drops from a * b, exactly; float64 must be between 1e-140 and 1e140, float32 1e-12 and 1e12."""
    a_high, b_high = high_half(a), high_half(b)
    a_low, b_low = a - a_high, b - b_high
    return a_low * b_low - (((a * b - a_high * b_high) - a_low * b_high) - a_high * b_low)


def high_half(x: Number) -> Number:
    """x to half of its bits (Veltkamp), so that products of halves are exact."""
    shifted = x * (2.0 ** (27 if np.asarray(x).itemsize == 8 else 12) + 1.0)
    return shifted - (shifted - x)


def minimum(a: Number, b: Number) -> Number:
    """The lesser; b where one of the two is NaN."""
    return where(a < b, a, b)


def maximum(a: Number, b: Number) -> Number:
    """The greater; b where one of the two is NaN."""
    return where(a > b, a, b)


def width(values: Any) -> int:
    """How many rays of their precision, float64 or float32, a kernel traces at once."""
    return BYTES // int(values.dtype.itemsize)


def splat(x: float, like: Number) -> Number:
    """The same number for each ray, in the precision of the lanes `like`; what is one for each ray stays."""
    return np.full_like(like, x)[()]


def load(values: Any, start: int) -> Number:
    """A number for each ray: those of an array from index `start` on."""
    return values[start : start + width(values)].copy()


def gather(values: Any, places: Number) -> Number:
    """For each ray the number of an array at a whole-number place, in the precision of the places."""
    return np.asarray(values[np.asarray(places).astype(np.int64)]).astype(np.asarray(places).dtype)[()]


def save(x: Number, values: Any, start: int) -> None:
    """Put the numbers of all rays into an array from index `start` on."""
    values[start : start + width(values)] = x


def lane(x: Number, ray: int) -> float:
    """The number of one ray."""
    return float(x[ray])


def greatest(x: Number) -> float:
    """The greatest number of all rays, -infinity where all are NaN."""
    return float(np.fmax.reduce(x, initial=-np.inf))


def first(mask: Mask) -> int:
    """The index of the first ray for which the mask is true; there must be one."""
    return int(np.argmax(mask))


def lowest(number: int) -> int:
    """The lowest bit of a number that is not 0."""
    return (number & -number).bit_length() - 1
