"""Quadratic equations of rays and quadrics, solved without cancellation, and rays that start on such a surface.

For rays that start on the surface of a quadric, or close to it on the scale of the solid, nearly everything cancels.
The height of such a start above the surface is computed to 32 digits (`minirt.shapes.compensated`), and t is counted
from the start. A start whose height is no more than the rounding of its coordinates is on the surface, and no ray hits
the surface where it starts: one that goes inwards hits the other side, and one that goes outwards leaves the solid.

Shadow rays start clear of all surfaces and need none of this: where `anywhere` is None the formulas of quadrics leave
it out, which saves a kernel a third of its size.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any

from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    copysign,
    fabs,
    max_norm,
    maximum,
    minimum,
    rarely,
    splat,
    sqrt,
    unit_roundoff,
    where,
)
from minirt.shapes.compensated import Pair, along, minus, offset, squared_length, times

CLOSE = 2.0**-6  # to a surface: share of a solid's size, or of the square of its radius there
POSITION = 2.0  # unit roundoffs of the largest coordinate; rounding a point moves it by at most sqrt(3) of them
ROUNDING = 16.0  # unit roundoffs of a solid's size by which a plain height above its surface may be off, and more


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


def first_overlap(
    a: Number, per_a: Number, b: Number, c: Number, product: Number, start: Number, first: Number, last: Number
) -> tuple[Mask, Number]:
    """Whether the interval of `negative_interval` and the one from `first` to `last` overlap at t > 0, and where first.

    The quadratic equation counts t from `start`, the second interval from the ray's origin, as the result does.
    """
    hit, below, above = negative_interval(a, per_a, b, c, product)
    t = start
    if any(hit):
        near = maximum(start + below, first)
        far = minimum(start + above, last)
        t = where(near > 0.0, near, far)
        hit = hit & (near <= far) & (t > 0.0)
    return hit, t


def starts_close(
    a: Number, b: Number, level: Number, squared: Number, over: Number, size: Number, outwards: Number
) -> Mask:
    """Whether a ray starts in a solid of revolution or close above it, close to the surface, and may hit it there.

    `level` is by how much the square of its start's distance from the axis exceeds that of the side there, which is
    about `squared`; `over` is its height above the nearer cap. `a` and `b` are those of its quadratic equation; it goes
    away from the middle between the caps if `outwards` > 0. It may hit nothing if it starts clearly above the side or a
    cap and goes away from it, as most mirrored rays do.
    """
    within = (level <= CLOSE * squared) & (over <= CLOSE * size)
    if rarely(within):
        error = ROUNDING * unit_roundoff(a) * size
        near = (level >= -CLOSE * squared) | (over >= -CLOSE * size)
        inwards = (a < 0.0) | (b < 0.0) | (level * fabs(level) <= error * error * squared)
        return within & near & inwards & ((outwards < 0.0) | (over <= error))
    return a > inf  # no ray


def beside_side(level: Number, squared: Number, over: Number, half: Number) -> Mask:
    """Whether a point is close to the side, on the scale of its squared distance from the axis and of half the height.

    There t is counted from the ray's start. For a start beyond the caps, or in the mirror image of a cone, it is not.
    """
    return (fabs(level) <= CLOSE * squared) & (over <= CLOSE * half)


def position_error(origin: Vec, p: Vec) -> Number:
    """Distance to a surface below which a ray starts on it. p is the origin in the frame of the solid."""
    return POSITION * unit_roundoff(p.x) * maximum(max_norm(origin), max_norm(p))


def error_of_start(origin: Vec, p: Vec, level: Number, slope: Number, over: Number) -> Number:
    """Distance below which a ray starts on the side or on a cap, 0 for rays that start beyond the edge of one.

    Twice the `slope` is the gradient of `level`.
    """
    error = position_error(origin, p)
    return where((level <= 2.0 * slope * error) & (over <= error), error, 0.0)


def zero_within(x: Number, error: Number) -> Number:
    """Return x, or exactly 0 where x is no more than its error."""
    return where(fabs(x) <= error, 0.0, x)


def axial(shape: Any, origin: Vec, like: Number) -> tuple[Pair, Pair]:
    """Compute the height of a ray's origin along the axis of a packed shape, and its squared distance from the axis.

    All numbers become lanes as `like` is, so that kernels compile these operations once.
    """
    f = offset(splat(origin, like), splat(shape.centre, like))
    height = along(f, splat(shape.w, like), splat(shape.w_low, like))
    return height, minus(squared_length(f), times(height, height))


def between_caps(height: Pair, bottom: Number, top: Number, per_height: Number, error: Number) -> tuple[Number, Number]:
    """Return the t at which a ray from this height passes the planes of the caps, in ascending order."""
    one = zero_within((bottom - height[0]) - height[1], error) * per_height
    other = zero_within((top - height[0]) - height[1], error) * per_height
    return minimum(one, other), maximum(one, other)
