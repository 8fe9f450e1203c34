"""The quadratic that every quadric ends in, solved without cancellation."""

from __future__ import annotations

from math import inf

from minirt.lanes import any, copysign, maximum, minimum, sqrt, where
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask


def below_zero(a: Number, b: Number, c: Number) -> tuple[Mask, Number, Number]:
    """Where a t^2 + 2 b t + c <= 0 or, for a < 0, >= 0: whether anywhere, and the ends of the interval.

    q adds two numbers of the same sign, so q / a and c / q are both exact to a few roundings (Press et al., Numerical
    Recipes, 5.6). With q = 0 the parabola touches zero at t = 0 or, where a = 0 too, is the constant c.
    """
    D = b * b - a * c
    hit = D >= 0.0
    low = b
    high = b
    if any(hit):
        q = -(b + copysign(sqrt(D), b))
        level = q == 0.0
        constant = level & (a == 0.0)
        r0 = where(constant, -inf, q / a)
        r1 = where(constant, inf, where(level, 0.0, c / q))
        low = minimum(r0, r1)
        high = maximum(r0, r1)
        hit = hit & (~constant | (c <= 0.0))
    return hit, low, high


def deepest(a: Number, b: Number, first: Number, last: Number) -> Number:
    """Where, between two t, a t^2 + 2 b t + c is least, for a >= 0.

    Of a ray that meets a solid between two planes that place lies in the solid, or as near to it as rounding lets it:
    counted from there all numbers are as small as the solid there is wide, however long it is and wherever its middle.
    """
    return minimum(maximum(-b / a, first), last)
