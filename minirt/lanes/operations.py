"""SIMD operations, interpreted: on numpy float64 and on arrays with one number for each ray."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes.vec import Number, Vec, dot

BYTES = 128  # size of all lanes of a number: 16 float64 or 32 float32
Mask = Any  # a numpy bool, an array with one for each ray, or a SIMD mask


def where(mask: Mask, a: Any, b: Any) -> Any:
    """Select `a` for rays where the mask is true and `b` for the others; select Vecs component by component."""
    if isinstance(a, Vec):
        return Vec(where(mask, a.x, b.x), where(mask, a.y, b.y), where(mask, a.z, b.z))
    return np.where(mask, a, b)[()]


def any(mask: Mask) -> bool:
    """Whether the mask is true for at least one ray."""
    return bool(np.any(mask))


def rarely(mask: Mask) -> bool:
    """Whether the mask is true for any ray; compiled, the branch is marked as unlikely."""
    return any(mask)


def sqrt(x: Number) -> Number:
    """Return the square root, NaN below 0."""
    return np.sqrt(x)


def inverse_root(x: Number) -> Number:
    """Return 1 / sqrt(x) for a positive normal number; compiled, the last two bits may differ."""
    return 1.0 / np.sqrt(x)


def unit(v: Vec) -> Vec:
    """Return the vector of length 1 in the direction of v."""
    return v * inverse_root(dot(v, v))


def unit_roundoff(x: Number) -> float:
    """Return the largest relative error of rounding to the precision of x: 2^-53, or 2^-24 for float32."""
    return float(np.finfo(np.asarray(x).dtype).eps) / 2


def fabs(x: Number) -> Number:
    """Return the absolute value."""
    return np.fabs(x)


def floor(x: Number) -> Number:
    """Return the greatest whole number not above x."""
    return np.floor(x)


def exponent(x: Number) -> Number:
    """Return the greatest whole number e with 2^e <= x, for x >= 0; for 0 and denormals, one below all others."""
    least = np.finfo(np.asarray(x).dtype).minexp
    return np.maximum(np.where(x > 0.0, np.frexp(x)[1] - 1, least - 1), least - 1).astype(np.asarray(x).dtype)[()]


def two_to(x: Number) -> Number:
    """Return 2^x for a whole number x up to the largest `exponent`; 0 where 2^x is below the least normal number."""
    dtype = np.asarray(x).dtype
    power = np.ldexp(dtype.type(1), np.asarray(x).astype(int))
    return np.where(x < np.finfo(dtype).minexp, 0.0, power).astype(dtype)[()]


def copysign(x: Number, sign: Number) -> Number:
    """Return the absolute value of x with the sign of `sign`."""
    return np.copysign(x, sign)


def rounded_product(a: Number, b: Number) -> Number:
    """Return a * b, rounded: never fused with a sum that follows."""
    return a * b


def product_error(a: Number, b: Number) -> Number:
    """Return the exact rounding error of a * b (Dekker 1971); float64 within 1e-140 to 1e140, float32 1e-12 to 1e12."""
    a_high, b_high = high_half(a), high_half(b)
    a_low, b_low = a - a_high, b - b_high
    return a_low * b_low - (((a * b - a_high * b_high) - a_low * b_high) - a_high * b_low)


def high_half(x: Number) -> Number:
    """Return x rounded to half of its bits (Veltkamp 1968), so that products of halves are exact."""
    shifted = x * (2.0 ** (27 if np.asarray(x).itemsize == 8 else 12) + 1.0)
    return shifted - (shifted - x)


def minimum(a: Number, b: Number) -> Number:
    """Return the lesser number; b where one of the two is NaN."""
    return where(a < b, a, b)


def maximum(a: Number, b: Number) -> Number:
    """Return the greater number; b where one of the two is NaN."""
    return where(a > b, a, b)


def width(values: Any) -> int:
    """Return the count of lanes: how many rays a kernel traces at once in the precision of the values."""
    return BYTES // int(values.dtype.itemsize)


def splat(x: float, like: Number) -> Number:
    """Return the same number for each ray, in the precision of the lanes `like`; lanes stay as they are."""
    return np.full_like(like, x)[()]


def load(values: Any, start: int) -> Number:
    """Load a number for each ray from an array, from index `start` on."""
    return values[start : start + width(values)].copy()


def gather(values: Any, indices: Number) -> Number:
    """Load for each ray the number at its own whole-number index of an array, in the precision of the indices."""
    return np.asarray(values[np.asarray(indices).astype(np.int64)]).astype(np.asarray(indices).dtype)[()]


def save(x: Number, values: Any, start: int) -> None:
    """Store the numbers of all rays in an array, from index `start` on."""
    values[start : start + width(values)] = x


def lane(x: Number, ray: int) -> float:
    """Return the number of one ray."""
    return float(x[ray])


def greatest(x: Number) -> float:
    """Return the greatest number of all rays, -infinity if all are NaN."""
    return float(np.fmax.reduce(x, initial=-np.inf))


def first(mask: Mask) -> int:
    """Return the index of the first ray for which the mask is true; there must be one."""
    return int(np.argmax(mask))


def lowest(number: int) -> int:
    """Return the index of the lowest bit that is set in a positive integer."""
    return (number & -number).bit_length() - 1
