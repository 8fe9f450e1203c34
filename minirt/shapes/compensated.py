"""Compensated arithmetic: sums and products with their rounding errors, for where nearly everything cancels.

The pairs of a rounded result and its error are exact: two-sum (Moller 1965; Knuth 1969, The Art of Computer Programming
2, 4.2.2) and two-product (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
"""

from __future__ import annotations

from typing import Any

from minirt.lanes import (
    Number,
    Vec,
    fabs,
    max_norm,
    maximum,
    product_error,
    rounded_product,
    splat,
    unit_roundoff,
    where,
)

POSITION = 8.0  # unit roundoffs of the largest coordinate, by which a point that was computed may be off its surface
Pair = tuple[Number, Number]  # a number of twice the precision: its rounded value, and what that lacks
Pairs = tuple[Pair, Pair, Pair]  # a vector: x, y and z


def two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded sum a + b and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def quick_two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """The rounded sum a + b and its rounding error, for |a| >= |b| (Dekker 1971)."""
    total = a + b
    return total, b - (total - a)


def two_product(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded product a * b and its rounding error."""
    return rounded_product(a, b), product_error(a, b)


def pair(high: Number, low: Number, like: Number) -> Pair:
    """A number and what it lacks, as a pair of lanes as `like` is."""
    return splat(high, like), splat(low, like)


def plus(a: Pair, b: Pair) -> Pair:
    """The sum of two pairs."""
    total, error = two_sum(a[0], b[0])
    return quick_two_sum(total, error + (a[1] + b[1]))


def times(a: Pair, b: Pair) -> Pair:
    """The product of two pairs."""
    product, error = two_product(a[0], b[0])
    return product, error + (a[0] * b[1] + a[1] * b[0])


def minus(a: Pair, b: Pair) -> Pair:
    """The difference of two pairs."""
    return plus(a, (-b[0], -b[1]))


def divided(a: Pair, b: Number) -> Pair:
    """The quotient a / b of a pair and a number."""
    per_b = 1.0 / b
    high = a[0] * per_b
    return high, value(minus(a, two_product(high, b))) * per_b


def square_of(x: Number, like: Number) -> Pair:
    """The square of a number, as a pair of lanes as `like` is."""
    lanes = splat(x, like)
    return two_product(lanes, lanes)


def value(a: Pair) -> Number:
    """A pair as one number."""
    return a[0] + a[1]


def offset(point: Vec, centre: Vec) -> Pairs:
    """The exact vector from `centre` to `point`, as pairs x, y and z."""
    return two_sum(point.x, -centre.x), two_sum(point.y, -centre.y), two_sum(point.z, -centre.z)


def pairs(v: Vec, like: Number) -> Pairs:
    """A vector as pairs of lanes as `like` is."""
    return pair(v.x, 0.0, like), pair(v.y, 0.0, like), pair(v.z, 0.0, like)


def along(f: Pairs, w: Pairs, excess: Number) -> Pair:
    """The component of a vector along w, whose length exceeds 1 by `excess`, a rounding."""
    high, low = scalar_product(f, w)
    return high, low - excess * high


def rounded(v: Pairs) -> Vec:
    """A vector of pairs as one of numbers."""
    return Vec(value(v[0]), value(v[1]), value(v[2]))


def scalar_product(f: Pairs, g: Pairs) -> Pair:
    """The scalar product of two vectors."""
    x, y, z = times(f[0], g[0]), times(f[1], g[1]), times(f[2], g[2])
    partly, error = two_sum(x[0], y[0])
    total, last = two_sum(partly, z[0])
    return quick_two_sum(total, (error + last) + (x[1] + y[1] + z[1]))


def position_error(origin: Vec, p: Vec) -> Number:
    """Distance to a surface below which a ray starts on it. p is the way to the origin from the shape's centre."""
    return POSITION * unit_roundoff(p.x) * maximum(max_norm(origin), max_norm(p))


def zero_within(x: Number, error: Number) -> Number:
    """Return x, or exactly 0 where x is no more than its error."""
    return where(fabs(x) <= error, 0.0, x)
