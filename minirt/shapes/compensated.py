"""Compensated arithmetic: sums and products with their rounding errors, for where nearly everything cancels.

The pairs of a rounded result and its error are exact: two-sum (Moller 1965; Knuth 1969, The Art of Computer Programming
2, 4.2.2) and two-product (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
"""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Context, Decimal, localcontext
from math import copysign
from typing import Any

from minirt.fields import Triple, cos_and_sin
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

EXACT = Context(prec=60)  # digits
POSITION = 8.0  # unit roundoffs of the largest coordinate, by which a point that was computed may be off its surface
Pair = tuple[Number, Number]  # a number of twice the precision: its rounded value, and what that lacks
Pairs = tuple[Pair, Pair, Pair]  # a vector: x, y and z


def two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded sum a + b and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded product a * b and its rounding error."""
    return rounded_product(a, b), product_error(a, b)


def quick_two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """The rounded sum a + b and its rounding error, for |a| >= |b| (Dekker 1971)."""
    total = a + b
    return total, b - (total - a)


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


def pairs(v: Vec, low: Vec, like: Number) -> Pairs:
    """A vector and what it lacks, as pairs of lanes as `like` is."""
    return pair(v.x, low.x, like), pair(v.y, low.y, like), pair(v.z, low.z, like)


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


# Low parts of rounded numbers in packed shapes: what the numbers lack. With them a shape is known to 32 digits. Where a
# ray starts closely above a huge shape, the rounding of an axis or a slope moves the surface by more than the height of
# the start.


def scaled_to_unit(*numbers: float) -> list[Decimal]:
    """Scale numbers, of which the squares add up to 1 but for rounding, so that they do exactly."""
    exact = [Decimal(x) for x in numbers]
    length = EXACT.sqrt(sum(x * x for x in exact))
    return [x / length for x in exact]


def lacking(exact: Iterable[Decimal], rounded: Vec) -> Vec:
    """What the numbers of a rounded vector lack."""
    parts = zip(exact, (rounded.x, rounded.y, rounded.z), strict=True)
    return Vec(*(float(part - Decimal(number)) for part, number in parts))


def basis_low(axis: Triple, roll: float, u: Vec, v: Vec, w: Vec) -> tuple[Vec, Vec, Vec]:
    """What the vectors u, v, w of `minirt.shapes.frames.basis` lack."""
    with localcontext(EXACT):
        x, y, z = scaled_to_unit(*axis)
        c, s = scaled_to_unit(*cos_and_sin(roll))
        sign = Decimal(copysign(1.0, axis[1]))
        a = -1 / (sign + y)
        pairs = ((sign * z * x * a, sign + x * x * a), (-sign * z, -x), (1 + sign * z * z * a, z * x * a))
        rolled_u, rolled_v = [c * p + s * q for p, q in pairs], [c * q - s * p for p, q in pairs]
        return lacking(rolled_u, u), lacking(rolled_v, v), lacking((x, y, z), w)
