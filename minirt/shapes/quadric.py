"""Quadratic equations of rays and quadrics, solved without cancellation."""

from __future__ import annotations

from math import inf, nan

from minirt.lanes import Mask, Number, any, copysign, maximum, minimum, rarely, splat, sqrt, where


def negative_interval(a: Number, per_a: Number, b: Number, c: Number, product: Number) -> tuple[Mask, Number, Number]:
    """Solve a t^2 + 2 b t + c = 0: whether it has real roots, and where the parabola falls below 0 and rises above it.

    For a > 0 the roots are in ascending order, for a < 0 in descending order; NaN where there are none. `per_a` is
    1 / a. q adds two numbers of the same sign, so q / a and c / q are both exact to a few roundings (Press et al.,
    Numerical Recipes, 5.6). `product` is c, or 0 where the root c / q is to be exactly 0. With q = 0 the parabola
    touches zero at t = 0 or, if a = 0 too, is the constant c: below zero from -infinity or from infinity on.
    """
    D = b * b - a * c
    real = D >= 0.0
    below = splat(nan, D)
    above = below
    if any(real):
        q = -(b + copysign(sqrt(D), b))
        by_a, by_c = q * per_a, product / q
        level = q == 0.0
        if rarely(level):
            by_c = where(level, where(a == 0.0, where(c > 0.0, inf, -inf), 0.0), by_c)
        falling = q < 0.0
        below = where(falling, by_a, by_c)
        above = where(falling, by_c, by_a)
    return real, below, above


def clamped_minimum(per_a: Number, b: Number, first: Number, last: Number) -> Number:
    """The t in [first, last] at which a t^2 + 2 b t + c is least, for a >= 0; for a < 0 some t in it.

    For a ray that hits a solid between two planes this point lies in the solid, within rounding. Counted from there all
    numbers are as small as the solid is wide there, however long it is and wherever its middle is. A ray with a < 0 is
    steeper than the solid's side, and between the planes never farther away than the solid is wide.
    """
    return minimum(maximum(-b * per_a, first), last)
