"""Compensated arithmetic: sums and products with their rounding errors, for where nearly everything cancels.

The pairs of a rounded result and its error are exact: two-sum (Moller 1965; Knuth 1969, The Art of Computer Programming
2, 4.2.2) and two-product (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
"""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Context, Decimal, localcontext
from math import copysign, inf, isfinite, prod

from minirt.fields import Triple, cos_and_sin
from minirt.lanes import Number, Vec, product_error, rounded_product

EXACT = Context(prec=60)  # digits
Pair = tuple[Number, Number]  # a number of twice the precision: its rounded value, and what that lacks


def two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded sum a + b and its rounding error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: Number, b: Number) -> tuple[Number, Number]:
    """The rounded product a * b and its rounding error."""
    return rounded_product(a, b), product_error(a, b)


def power_of_point(point: Vec, centre: Vec, radius: Number) -> Number:
    """Power of a point with respect to a sphere, |point - centre|^2 - radius^2, to nearly full precision.

    It is the product of the distances to both hits of any line through the point. Near the surface, where the plain
    difference cancels, all digits are kept.
    """
    (x, x_low), (y, y_low), (z, z_low) = offset(point, centre)
    xx, xx_low = two_product(x, x)
    yy, yy_low = two_product(y, y)
    zz, zz_low = two_product(z, z)
    rr, rr_low = two_product(radius, radius)
    total, low_1 = two_sum(xx, yy)
    total, low_2 = two_sum(total, zz)
    squares = xx_low + yy_low + zz_low - rr_low
    mixed = 2.0 * (x * x_low + y * y_low + z * z_low)
    return (total - rr) + (low_1 + low_2 + squares + mixed)  # near the sphere that difference is exact


def plus(a: Pair, b: Pair) -> Pair:
    """The sum of two pairs."""
    total, error = two_sum(a[0], b[0])
    return total, error + (a[1] + b[1])


def times(a: Pair, b: Pair) -> Pair:
    """The product of two pairs."""
    product, error = two_product(a[0], b[0])
    return product, error + (a[0] * b[1] + a[1] * b[0])


def minus(a: Pair, b: Pair) -> Pair:
    """The difference of two pairs."""
    return plus(a, (-b[0], -b[1]))


def divided(a: Pair, b: Number, per_b: Number) -> Pair:
    """The quotient a / b of a pair and a number, where `per_b` is 1 / b, rounded."""
    high = a[0] * per_b
    return high, value(minus(a, two_product(high, b))) * per_b


def value(a: Pair) -> Number:
    """A pair as one number."""
    return a[0] + a[1]


def offset(point: Vec, centre: Vec) -> tuple[Pair, Pair, Pair]:
    """The exact vector from `centre` to `point`, as pairs x, y and z."""
    return two_sum(point.x, -centre.x), two_sum(point.y, -centre.y), two_sum(point.z, -centre.z)


def along(f: tuple[Pair, Pair, Pair], axis: Vec, low: Vec) -> Pair:
    """The component of the vector f along a unit vector, of which `low` is what the rounded `axis` lacks."""
    x, y, z = f
    return plus(plus(times(x, (axis.x, low.x)), times(y, (axis.y, low.y))), times(z, (axis.z, low.z)))


def squared_length(f: tuple[Pair, Pair, Pair]) -> Pair:
    """|f|^2."""
    x, y, z = f
    return plus(plus(times(x, x), times(y, y)), times(z, z))


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


def axis_low(axis: Triple) -> Vec:
    """What an axis lacks to be exactly as long as 1."""
    with localcontext(EXACT):
        return lacking(scaled_to_unit(*axis), Vec(*axis))


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


def quotient_low(above: tuple[float, ...], below: tuple[float, ...], rounded: float) -> float:
    """What the rounded quotient of two products lacks."""
    if not isfinite(rounded):
        return 0.0
    with localcontext(EXACT):
        top, bottom = (prod(map(Decimal, each), start=Decimal(1)) for each in (above, below))
        return float(top / bottom - Decimal(rounded))


def root_low(diameter: float, waist: float, height: float, rounded: float) -> float:
    """What sqrt(diameter^2 - waist^2) / height, rounded, lacks."""
    if not 0.0 < rounded < inf:
        return 0.0
    with localcontext(EXACT):
        wide, thin, high, root = map(Decimal, (diameter, waist, height, rounded))
        return float(((wide * wide - thin * thin) / (high * high) - root * root) / (2 * root))  # Newton's step
