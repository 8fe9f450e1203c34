"""Arctangent, powers and gradient noise on SIMD lanes: the functions of a library take no lanes."""

from __future__ import annotations

from math import pi

from minirt.lanes import Number, Vec, copysign, dot, exponent, fabs, floor, maximum, splat, two_to, where

ROOT = 2.0**0.5
LOWEST = -1100.0  # 2^LOWEST is 0
ATAN_HALF = 0.463647609000806116  # arctan(1/2)


def arctan2(y: Number, x: Number) -> Number:
    """Return the angle from the x axis to (x, y), from -pi to pi, within 3 units in the last place.

    Zeros of both signs, infinities and NaN give what IEEE 754 says. The angle is found from the angle to the nearer
    axis, which is at most pi / 4.
    """
    a, b = fabs(y), fabs(x)
    steep = a > b
    smaller, larger = where(steep, b, a), where(steep, a, b)
    ratio = smaller / larger  # NaN for two zeros or infinities, which meet at the angle of 0 and of 1
    ratio = where(smaller == larger, where(larger == 0.0, 0.0, splat(1.0, ratio)), ratio)
    angle = arctan(ratio)
    angle = where(steep, 0.5 * pi - angle, angle)
    angle = where(copysign(1.0, x) < 0.0, pi - angle, angle)
    return copysign(angle, y)


def arctan(q: Number) -> Number:
    """Return the arctangent of q in [0, 1].

    By the addition theorem it is the arctangent of c, the nearest of 0, 1/2 and 1, plus that of s = (q - c) / (1 + c q)
    in [-1/4, 1/4], which is a Taylor series.
    """
    upper, middle = q > 0.75, q > 0.25
    c = where(upper, 1.0, where(middle, 0.5, splat(0.0, q)))
    s = (q - c) / (1.0 + c * q)
    z = s * s
    series = splat(1.0 / 25.0, z)
    for n in range(23, 1, -2):
        series = 1.0 / n - z * series
    nearest = where(upper, 0.25 * pi, where(middle, ATAN_HALF, splat(0.0, q)))
    return nearest + (s - s * z * series)


def power(x: Number, n: Number) -> Number:
    """Return x^n = 2^(n log2(x)) for x in [0, 1] and n >= 1.

    In float64 its relative error is below 1e-15 + 6e-16 n |ln x|; the second term is from two roundings of n ln x.
    """
    return exp2(maximum(n * log2(x), LOWEST))


def log2(x: Number) -> Number:
    """Return the logarithm to base 2 of a positive number; for 0 a number below -126.

    It is the exponent of x plus log2(m) = 2 artanh(s) / ln 2, a series in s, where the mantissa m = (1 + s) / (1 - s)
    is in [sqrt(1/2), sqrt(2)].
    """
    whole = exponent(x)
    m = x * two_to(-whole)
    upper = m > ROOT
    m = where(upper, 0.5 * m, m)
    whole = where(upper, whole + 1.0, whole)
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = splat(1.0 / 23.0, z)
    for n in range(21, 0, -2):
        series = series * z + 1.0 / n
    return whole + 2.885390081777926815 * s * series  # 2 / ln 2


def exp2(y: Number) -> Number:
    """Return 2^y for y in [`LOWEST`, 0]: 2 to the nearest whole number, times the Taylor series of the remainder."""
    whole = floor(y + 0.5)
    x = 0.693147180559945309 * (y - whole)
    series = splat(1.0, x)
    for n in range(14, 0, -1):
        series = 1.0 + 1.0 / n * x * series
    return series * two_to(whole)


# Gradient noise (Perlin, Improving Noise, 2002): a smooth random function of space. Space is cut into unit cubes. Each
# corner has one of twelve gradients, from the middle of a cube to those of its edges, and the noise is the blend of the
# eight linear functions with these gradients that are 0 at their own corner. It is 0 at all corners, and its first and
# second derivatives are continuous.
#
# Perlin looks up the gradient of a corner in a table. Here it is a formula, after McEwan and others (Efficient
# Computational Noise in GLSL, 2012): cubing permutes the remainders of a prime number p if 3 does not divide p - 1. A
# table would have to be gathered lane by lane: noise took 1.4 times as long with AVX-512, 2.3 times in float32.
PERIOD = 149.0  # cells after which the noise repeats: a prime; cubes of remainders are exact even in float32
START = 23.0  # moves the place about which cubes are symmetric away from the origin
GREATEST = 1.0363538  # bound of the noise: the largest blend of the corners' steepest functions, by tests/lanes


def noise_and_gradient(p: Vec) -> tuple[Number, Vec]:
    """Return the noise at p, from -`GREATEST` to `GREATEST` and 0 on average, and its gradient.

    The cube of p has the corner x, y, z; f is the place in the cube. Of the four edges along x, with noise n and
    gradient g, the first digit tells whether their y is greater by 1, the second whether their z is.
    """
    x, y, z = floor(p.x), floor(p.y), floor(p.z)
    x0, y0, z0 = remainder(x + START), remainder(y + START), remainder(z + START)
    x1, y1 = remainder(x + (START + 1.0)), remainder(y + (START + 1.0))
    near, far = scrambled(z0), scrambled(remainder(z + (START + 1.0)))
    a, b, c, d = scrambled(near + y0), scrambled(near + y1), scrambled(far + y0), scrambled(far + y1)
    f = Vec(p.x - x, p.y - y, p.z - z)
    u, v, w = ease(f.x), ease(f.y), ease(f.z)
    du, dv, dw = ease_slope(f.x), ease_slope(f.y), ease_slope(f.z)
    n00, g00 = edge(scrambled(a + x0), scrambled(a + x1), f.x, f.y, f.z, u, du)
    n10, g10 = edge(scrambled(b + x0), scrambled(b + x1), f.x, f.y - 1.0, f.z, u, du)
    n01, g01 = edge(scrambled(c + x0), scrambled(c + x1), f.x, f.y, f.z - 1.0, u, du)
    n11, g11 = edge(scrambled(d + x0), scrambled(d + x1), f.x, f.y - 1.0, f.z - 1.0, u, du)
    front, back = n00 + v * (n10 - n00), n01 + v * (n11 - n01)
    slope_front, slope_back = g00 + v * (g10 - g00), g01 + v * (g11 - g01)
    slope = slope_front + w * (slope_back - slope_front)
    over_y = (n10 - n00) + w * ((n11 - n01) - (n10 - n00))
    gradient = Vec(slope.x, slope.y + dv * over_y, slope.z + dw * (back - front))
    return front + w * (back - front), gradient


def edge(h0: Number, h1: Number, x: Number, y: Number, z: Number, u: Number, du: Number) -> tuple[Number, Vec]:
    """Blend the functions of two corners that lie one behind the other along x, and their gradients."""
    g0, g1 = corner_gradient(h0), corner_gradient(h1)
    n0, n1 = dot(g0, Vec(x, y, z)), dot(g1, Vec(x - 1.0, y, z))
    slope = g0 + u * (g1 - g0)
    return n0 + u * (n1 - n0), Vec(slope.x + du * (n1 - n0), slope.y, slope.z)


def corner_gradient(h: Number) -> Vec:
    """Return the gradient of a corner: two components are 1 or -1, one is 0."""
    third = h * (3.0 / PERIOD) + 1.5  # from 0 to 3: which component is 0; its fraction gives the signs
    part = third - floor(third) - 0.5
    one = copysign(splat(1.0, h), part)
    other = copysign(splat(1.0, h), fabs(part) - 0.25)
    first, second = third < 1.0, third < 2.0
    return Vec(where(second, one, 0.0), where(first, other, where(second, 0.0, one)), where(first, 0.0, other))


def scrambled(s: Number) -> Number:
    """Permute the remainders: the remainder of s cubed. Below 1.5 `PERIOD` the cube is exact in float32, too."""
    return remainder(s * s * s)


def remainder(s: Number) -> Number:
    """Return s less the nearest multiple of `PERIOD`, for a whole number s: at most 74, of either sign."""
    return s - PERIOD * floor(s * (1.0 / PERIOD) + 0.5)


def ease(t: Number) -> Number:
    """Perlin's quintic: from 0 at 0 to 1 at 1, where its first and second derivatives are 0."""
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0)


def ease_slope(t: Number) -> Number:
    """The derivative of `ease`."""
    product = t * (t - 1.0)
    return 30.0 * (product * product)
