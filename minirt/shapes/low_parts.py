"""Low parts of rounded numbers in packed shapes: what the numbers lack. With them a shape is known to 32 digits.

Where a ray starts closely above a huge shape, the rounding of an axis or a slope moves the surface by more than the
height of the start. Low parts are computed in Python's integers, which are exact.
"""

from __future__ import annotations

from math import copysign, inf, isfinite, isqrt, ldexp, prod

from minirt.fields import Triple, cos_and_sin
from minirt.lanes import Vec

BITS = 160  # after the binary point
ONE = 1 << BITS


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
    """What the vectors u, v, w of `minirt.shapes.basis.basis` lack."""
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
