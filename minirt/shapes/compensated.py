"""Compensated arithmetic: sums and products with their rounding errors, for where nearly everything cancels.

The pairs of a rounded result and its error are exact: two-sum (Moller 1965; Knuth 1969, The Art of Computer Programming
2, 4.2.2) and two-product (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
"""

from __future__ import annotations

from math import copysign, inf, isfinite, isqrt, ldexp, prod

from minirt.fields import Triple, cos_and_sin
from minirt.lanes import Number, Vec, product_error, rounded_product

BITS = 160  # after the binary point
ONE = 1 << BITS
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
    x, x_low = two_sum(point.x, -centre.x)
    y, y_low = two_sum(point.y, -centre.y)
    z, z_low = two_sum(point.z, -centre.z)
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
# the start. Low parts are computed in Python's integers, which are exact.


def fixed(x: float) -> int:
    """x in units of 2^-160."""
    numerator, denominator = x.as_integer_ratio()
    return (numerator << BITS) // denominator


def vec_low(exact: tuple[int, int, int], rounded: Vec) -> Vec:
    """What the numbers of a rounded vector lack."""
    parts = zip(exact, (rounded.x, rounded.y, rounded.z), strict=True)
    x, y, z = (ldexp(part - fixed(number), -BITS) for part, number in parts)
    return Vec(x, y, z)


def exact_axis(axis: Triple) -> tuple[int, int, int]:
    """The axis scaled to exactly unit length, in units of 2^-160."""
    x, y, z = (fixed(part) for part in axis)
    length = isqrt(x * x + y * y + z * z)
    return x * ONE // length, y * ONE // length, z * ONE // length


def axis_low(axis: Triple) -> Vec:
    """What an axis lacks to be exactly as long as 1."""
    return vec_low(exact_axis(axis), Vec(*axis))


def exact_turn(degrees: float) -> tuple[int, int]:
    """The rounded cosine and sine of an angle, scaled so that their squares add up to exactly 1, in units of 2^-160."""
    c, s = (fixed(part) for part in cos_and_sin(degrees))
    length = isqrt(c * c + s * s)
    return c * ONE // length, s * ONE // length


def basis_low(axis: Triple, roll: float, u: Vec, v: Vec, w: Vec) -> tuple[Vec, Vec, Vec]:
    """What the vectors u, v, w of `minirt.shapes.frames.basis` lack."""
    x, y, z = exact_axis(axis)
    sign = int(copysign(1.0, axis[1]))
    a = -ONE * ONE // (sign * ONE + y)
    b = z * x * a // (ONE * ONE)
    exact_u = sign * b, -sign * z, ONE + sign * z * z * a // (ONE * ONE)
    exact_v = sign * ONE + x * x * a // (ONE * ONE), -x, b
    c, s = exact_turn(roll)
    rolled_u, rolled_v = combined(c, exact_u, s, exact_v), combined(c, exact_v, -s, exact_u)
    return vec_low(rolled_u, u), vec_low(rolled_v, v), vec_low((x, y, z), w)


def combined(a: int, u: tuple[int, int, int], b: int, v: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return a u + b v, in units of 2^-160."""
    x, y, z = ((a * p + b * q) // ONE for p, q in zip(u, v, strict=True))
    return x, y, z


def product(factors: tuple[float, ...]) -> tuple[int, int]:
    """The product of some numbers, exactly: numerator and denominator."""
    ratios = [x.as_integer_ratio() for x in factors]
    return prod(n for n, _ in ratios), prod(d for _, d in ratios)


def quotient_low(above: tuple[float, ...], below: tuple[float, ...], rounded: float) -> float:
    """What the rounded quotient of two products lacks."""
    if not isfinite(rounded):
        return 0.0
    (n, d), (m, e), (k, f) = product(above), product(below), rounded.as_integer_ratio()
    return (n * e * f - k * m * d) / (m * d * f)


def root_low(diameter: float, waist: float, height: float, rounded: float) -> float:
    """What sqrt(diameter^2 - waist^2) / height, rounded, lacks."""
    if not 0.0 < rounded < inf:
        return 0.0
    (n, d), (m, e) = product((diameter, diameter)), product((waist, waist))
    (k, f), (h, g) = product((rounded, rounded)), product((height, height))
    above = (n * e - m * d) * g * f - k * h * d * e  # of the squares' difference
    p, q = rounded.as_integer_ratio()
    return above * q / (2 * h * d * e * f * p)
