"""Angles, where pictures lie around something, of the verbs of the formulas: a library's know no lanes."""

from __future__ import annotations

from math import pi

from minirt.lanes.operations import copysign, fabs, splat, where
from minirt.lanes.vec import Number

ATAN_HALF = 0.463647609000806116


def arctan2(y: Number, x: Number) -> Number:
    """The angle from the x axis to (x, y), from -pi to pi, for all numbers as IEEE 754 says: also for zeros of both
    signs, infinities and NaN.

    It is within 3 units in the last place, in float64 and in float32, and follows from the angle to the nearer axis,
    which is at most pi / 4.
    """
    a, b = fabs(y), fabs(x)
    steep = a > b
    less, more = where(steep, b, a), where(steep, a, b)
    ratio = less / more
    ratio = where(less == more, where(more == 0.0, 0.0, splat(1.0, ratio)), ratio)
    angle = arctan(ratio)
    angle = where(steep, 0.5 * pi - angle, angle)
    angle = where(copysign(1.0, x) < 0.0, pi - angle, angle)
    return copysign(angle, y)


def arctan(q: Number) -> Number:
    """The arctangent of q in [0, 1]: that of the nearest of 0, 1/2 and 1, and of what is left by the addition theorem,
    s in [-1/4, 1/4], as Taylor's series."""
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
    turned = where(upper, 0.25 * pi, where(middle, ATAN_HALF, splat(0.0, q)))
    return turned + (s - s * z * series)
