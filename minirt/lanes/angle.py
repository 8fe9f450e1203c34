"""Arctangent on SIMD lanes, for texture coordinates around a shape: the arctan2 of a library takes no lanes."""

from __future__ import annotations

from math import pi

from minirt.lanes.operations import copysign, fabs, splat, where
from minirt.lanes.vec import Number

ATAN_HALF = 0.463647609000806116  # arctan(1/2)


def arctan2(y: Number, x: Number) -> Number:
    """Return the angle from the x axis to (x, y), from -pi to pi, within 3 units in the last place.

    Zeros of both signs, infinities and NaN give what IEEE 754 says. The angle is found from the angle to the nearer
    axis, which is at most pi / 4.
    """
    a, b = fabs(y), fabs(x)
    steep = a > b
    smaller, larger = where(steep, b, a), where(steep, a, b)
    ratio = smaller / larger
    ratio = where(smaller == larger, where(larger == 0.0, 0.0, splat(1.0, ratio)), ratio)
    angle = arctan(ratio)
    angle = where(steep, 0.5 * pi - angle, angle)
    angle = where(copysign(1.0, x) < 0.0, pi - angle, angle)
    return copysign(angle, y)


def arctan(q: Number) -> Number:
    """Return the arctangent of q in [0, 1].

    By the addition theorem it is the arctangent of c, the nearest of 0, 1/2 and 1, plus that of s in [-1/4, 1/4], which
    is a Taylor series.
    """
    upper, middle = q > 0.75, q > 0.25
    c = where(upper, 1.0, where(middle, 0.5, splat(0.0, q)))
    s = (q - c) / (1.0 + c * q)
    z = s * s
    series = 1.0 / 25.0
    series = 1.0 / 23.0 - z * series
    series = 1.0 / 21.0 - z * series
    series = 1.0 / 19.0 - z * series
    series = 1.0 / 17.0 - z * series
    series = 1.0 / 15.0 - z * series
    series = 1.0 / 13.0 - z * series
    series = 1.0 / 11.0 - z * series
    series = 1.0 / 9.0 - z * series
    series = 1.0 / 7.0 - z * series
    series = 1.0 / 5.0 - z * series
    series = 1.0 / 3.0 - z * series
    nearest = where(upper, 0.25 * pi, where(middle, ATAN_HALF, splat(0.0, q)))
    return nearest + (s - s * z * series)
