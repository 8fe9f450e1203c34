"""SIMD lanes: numbers that stand for one ray or for a packet of rays, and the operations on them.

A formula of a shape is written once, for one ray, with the operators of Python and the operations of this package. Its
caller decides on the numbers:

- a test passes a numpy float64 (a Python float that divides by zero as IEEE 754 says) and gets the plain formula;
- an interpreted kernel passes a numpy array of 16 float64 or 32 float32, one number for each ray of a packet;
- a compiled kernel passes the same numbers as one SIMD vector, `f64x16` or `f32x32` (`minirt.lanes.compiled.types`).

A number may stand for many, so a formula must not branch on it. `a < b` is a mask, a truth value for each ray; masks
combine with `&`, `|` and `~`; `where(mask, a, b)` selects for each ray; `if any(mask):` skips work that no ray needs.
Nothing else in a formula shows that it runs on several rays at once.

This package is the interpreted half and imports no compiler; `minirt.lanes.compiled` registers the same operations with
numba.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

BYTES = 128  # size of all lanes of a number: 16 float64 or 32 float32
Number = Any  # a numpy float64, an array with one for each ray, or a SIMD vector
F = TypeVar("F", bound=Callable[..., Any])
Mask = Any  # a numpy bool, an array with one for each ray, or a SIMD mask


class Vec:
    """A vector or a point: x, y and z, each a number in the sense of `minirt.lanes`."""

    __array_ufunc__ = None  # an array times a Vec is a Vec, not an array of Vecs
    __slots__ = ("x", "y", "z")

    def __init__(self, x: Number, y: Number, z: Number) -> None:
        self.x, self.y, self.z = x, y, z

    def __add__(self, other: Vec) -> Vec:
        return Vec(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec) -> Vec:
        return Vec(self.x - other.x, self.y - other.y, self.z - other.z)

    def __mul__(self, factor: Number) -> Vec:
        return Vec(self.x * factor, self.y * factor, self.z * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: Number) -> Vec:
        """Multiply by the inverse: one division instead of three, at the cost of a second rounding."""
        return self * (1.0 / divisor)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y, -self.z)

    def __repr__(self) -> str:
        return f"Vec({self.x}, {self.y}, {self.z})"


def outlined(function: F) -> F:
    """Mark a large function that is rarely called: a kernel contains it once, and is not slowed down by its size."""
    function.outlined = True  # type: ignore[attr-defined]
    return function


def cross(a: Vec, b: Vec) -> Vec:
    """Return the cross product."""
    return Vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


def dot(a: Vec, b: Vec) -> Number:
    """Return the dot product."""
    return a.x * b.x + a.y * b.y + a.z * b.z


def where(mask: Mask, a: Any, b: Any) -> Any:
    """Select `a` for rays where the mask is true and `b` for the others; Vecs and NamedTuples part by part."""
    if isinstance(a, tuple):
        return type(a)(*(where(mask, *parts) for parts in zip(a, b, strict=True)))
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


def splat(x: Any, like: Number) -> Any:
    """Return the same number or Vec for each ray, in the precision of the lanes `like`; lanes stay as they are."""
    if isinstance(x, Vec):
        return Vec(splat(x.x, like), splat(x.y, like), splat(x.z, like))
    return np.full_like(like, x)[()]


def load(values: Any, start: int) -> Number:
    """Load a number for each ray from an array, from index `start` on."""
    return values[start : start + width(values)].copy()


def in_single(x: Number) -> Number:
    """Return the numbers of rays, rounded to float32."""
    return x.astype(np.float32)


def gather(values: Any, start: int, indices: Number) -> Number:
    """Load for each ray the number at its own whole-number index, below 2^31, of an array from index `start` on.

    It is in the precision of the indices.
    """
    return np.asarray(values[start + np.asarray(indices).astype(np.int64)]).astype(np.asarray(indices).dtype)[()]


def save(x: Number, values: Any, start: int) -> None:
    """Store the numbers of all rays in an array, from index `start` on."""
    values[start : start + np.size(x)] = x


def load_vec(values: Any, start: int) -> Vec:
    """Load a Vec for each ray: all x from index `start` on, then all y, then all z."""
    count = width(values)
    return Vec(load(values, start), load(values, start + count), load(values, start + 2 * count))


def save_vec(v: Vec, values: Any, start: int) -> None:
    """Store the Vecs of all rays in an array, as `load_vec` loads them."""
    count = width(values)
    save(v.x, values, start)
    save(v.y, values, start + count)
    save(v.z, values, start + 2 * count)


def lane(x: Number, ray: int) -> float:
    """Return the number of one ray."""
    return float(x[ray])


def greatest(x: Number) -> float:
    """Return the greatest number of all rays, -infinity if all are NaN."""
    return float(np.fmax.reduce(x, initial=-np.inf))


def first(mask: Mask) -> int:
    """Return the index of the first ray for which the mask is true; there must be one."""
    return int(np.argmax(mask))


def bits(mask: Mask) -> int:
    """Return a mask as an integer with one bit for each ray, the lowest for the first ray."""
    return sum(1 << int(ray) for ray in np.flatnonzero(mask))


def lowest(number: int) -> int:
    """Return the index of the lowest bit that is set in a positive integer."""
    return (number & -number).bit_length() - 1


def max_norm(v: Vec) -> Number:
    """Return the maximum norm of a vector: the largest absolute value of a coordinate."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))
