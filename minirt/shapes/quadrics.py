"""Quadratic equations of rays and quadrics, solved without cancellation, and rays that start on or near such a surface.

For rays that start on the surface of a quadric, or close to it on the scale of the solid, nearly everything cancels.
Their equations are set up and solved with 32 digits (`minirt.shapes.compensated`) from the numbers that the scene
declares, t counted from the start. A start whose height is no more than the rounding of its coordinates is on the
surface, and no ray hits the surface where it starts: the nearer of the two ends is exactly 0. A ray that goes inwards
hits the other side, and one that goes outwards leaves the solid.

Shadow rays start clear of all surfaces and need none of this: where `limit` is not None the formulas of quadrics leave
it out, which saves a kernel a third of its size.
"""

from __future__ import annotations

from math import inf, nan
from typing import NamedTuple

from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    copysign,
    fabs,
    maximum,
    minimum,
    outlined,
    rarely,
    splat,
    sqrt,
    unit_roundoff,
    where,
)
from minirt.shapes.compensated import (
    Pair,
    Pairs,
    along,
    minus,
    offset,
    pair,
    pairs,
    plus,
    position_error,
    rounded,
    scalar_product,
    times,
    value,
)

CLOSE = 2.0**-6  # to a surface: share of a solid's size, or of the square of its radius there
PARALLEL = 2.0**-2  # share of its steepness by which a ray may be flatter than the side that it is still beside
SQUARED = 64.0  # squares of the unit roundoff by which a pair of about 1 may be off
BESIDE = 4.0  # unit roundoffs of a distance, within which two intervals meet
SHELL = (
    1 / CLOSE + 1
)  # CLOSE (r^2 + (SHELL e)^2) is at least (r + e)^2 - r^2 for every radius r: no start is overlooked
ROUNDING = 16.0  # unit roundoffs of a solid's size by which a plain height above its surface may be off, and more


class Span(NamedTuple):
    """The intervals of a line below a surface of revolution, and between the planes of the solid's ends."""

    a: Number  # of its quadratic equation; a line with a < 0 is steeper than the side
    below: Number  # t at which it falls below the surface, as of `negative_interval`
    above: Number  # t at which it rises above the surface
    first: Number  # t at which it passes the planes of the ends, in ascending order
    last: Number
    pace: Number  # upper bound of the distance by which the line nears the side or an end as t grows by 1


def negative_interval(a: Number, per_a: Number, b: Number, c: Number, start: Number) -> tuple[Number, Number]:
    """Solve a x^2 + 2 b x + c = 0: return the t at which the parabola falls below 0, and that at which it rises above.

    x is counted from `start`, and t = start + x. For a > 0 the roots are in ascending order, for a < 0 in descending
    order; NaN where there are none. `per_a` is 1 / a. q adds two numbers of the same sign, so q / a and c / q are both
    exact to a few roundings (Press et al., Numerical Recipes, 5.6).
    """
    D = b * b - a * c
    below = splat(nan, D)
    above = below
    if any(D >= 0.0):
        q = -(b + copysign(sqrt(D), b))
        below, above = in_order(q, q * per_a, c / q, a, c)
        below, above = start + below, start + above
    return below, above


def in_order(q: Number, by_a: Number, by_c: Number, a: Number, c: Number) -> tuple[Number, Number]:
    """Order the roots q / a and c / q: first the one at which the parabola falls below 0, then that where it rises.

    With q = 0 it touches zero at 0 or, if a = 0 too, is the constant c: below zero from -infinity or from infinity on.
    """
    level = q == 0.0
    if rarely(level):
        by_c = where(level, where(a == 0.0, where(c > 0.0, inf, -inf), 0.0), by_c)
    falling = q < 0.0
    return where(falling, by_a, by_c), where(falling, by_c, by_a)


def clamped_minimum(per_a: Number, b: Number, first: Number, last: Number) -> Number:
    """The t in [first, last] at which a t^2 + 2 b t + c is least, for a >= 0; for a < 0 some t in it.

    For a ray that hits a solid between two planes this point lies in the solid, within rounding. Counted from there all
    numbers are as small as the solid is wide there, however long it is and wherever its middle is. A ray with a < 0 is
    steeper than the solid's side, and between the planes never farther away than the solid is wide.
    """
    return minimum(maximum(-b * per_a, first), last)


def slab(z: Number, rise: Number, bottom: Number, top: Number) -> tuple[Number, Number]:
    """The t at which a line passes the heights `bottom` and `top`, in ascending order."""
    per_rise = 1.0 / rise
    one, other = (bottom - z) * per_rise, (top - z) * per_rise
    return minimum(one, other), maximum(one, other)


def first_overlap(span: Span) -> tuple[Mask, Number]:
    """Whether a ray is below the surface and between the planes of the ends at the same time t > 0, and when first.

    For rays with a >= 0, which are below the surface for one interval. Where a solid is thinner than the rounding of
    the ray's coordinates, both intervals may be so short that they are found beside each other.
    """
    hit = span.below == span.below  # not NaN
    t = span.first
    if any(hit):
        near, far = maximum(span.below, span.first), minimum(span.above, span.last)
        t = where(near > 0.0, near, far)
        hit = hit & (near * span.pace <= far * span.pace + BESIDE * unit_roundoff(far) * fabs(far)) & (t > 0.0)
    return hit, t


def first_overlap_of_steep(span: Span) -> tuple[Mask, Number]:
    """As `first_overlap`, for a surface that rays with a < 0 are below outside of an interval, which may be empty.

    Between the planes of the ends that leaves up to two intervals: the first one, unless it is empty or behind.
    """
    steep = span.a < 0.0
    end = minimum(span.above, span.last)
    over = steep & ((end < span.first) | (end <= 0.0))
    below = where(steep & ~over, span.first, span.below)
    above = where(over, span.last, span.above)
    return first_overlap(Span(span.a, below, above, span.first, span.last, span.pace))


def starts_close(
    a: Number, b: Number, level: Number, squared: Number, over: Number, size: Number, outwards: Number, off: Number
) -> Mask:
    """Whether a ray starts close to the surface of a solid of revolution, in it or above it, and may hit it there.

    A ray hits nothing if it starts clearly above the side or a cap and goes away from it, as most mirrored rays do.

    - `a` and `b` are those of the ray's quadratic equation, with t from the start.
    - `level` is by how much the square of the start's distance from the axis exceeds that of the side at its height.
    - `squared` is about that square of the side. `size` is that of the solid.
    - `over` is the height of the start above the plane of the nearer cap.
    - The ray goes away from the middle between the caps if `outwards` > 0.
    - The start may be `off` by the rounding of its coordinates.
    """
    squared = squared + (SHELL * off) * (SHELL * off)
    within = (level <= CLOSE * squared) & (over <= CLOSE * size)
    if rarely(within):
        error = ROUNDING * unit_roundoff(a) * size
        near = (level >= -CLOSE * squared) | (over >= -CLOSE * size)
        inwards = (a < 0.0) | (b < 0.0) | (level * fabs(level) <= error * error * squared)
        return within & near & inwards & ((outwards < 0.0) | (over <= error))
    return a > inf  # true for no ray


@outlined
def exact_span(centre: Vec, axis: Vec, origin: Vec, direction: Vec, side: Pairs, bottom: Number, top: Number) -> Span:
    """Return the span of a line through a packed solid of revolution, computed without any cancellation.

    t is counted from `origin`; `direction` has unit length. In its own frame, about `centre` and along `axis`, the
    solid's side is x^2 + y^2 = waist + 2 focal z + slope z^2, and `side` has waist, focal and slope. The solid lies
    between the heights `bottom` and `top`. All numbers become lanes as those of the pairs are, so that kernels compile
    these operations once.
    """
    waist, focal, slope = side
    like = waist[0]
    f = offset(splat(origin, like), splat(centre, like))
    d, w = pairs(direction, like), pairs(axis, like)
    excess = 0.5 * value(minus(scalar_product(w, w), pair(1.0, 0.0, like)))  # of the length of the rounded axis
    height, rise = along(f, w, excess), along(d, w, excess)
    across = minus(scalar_product(f, f), times(height, height))
    growth, spread = plus(focal, times(slope, height)), times(slope, rise)  # halves of the right side's derivative
    a = minus(scalar_product(d, d), times(rise, plus(rise, spread)))
    parallel = fabs(value(a)) <= SQUARED * unit_roundoff(like) * unit_roundoff(like)  # to a straight line of the side
    a = where(parallel, 0.0, a[0]), where(parallel, 0.0, a[1])
    b = minus(scalar_product(f, d), times(rise, plus(height, growth)))
    c = minus(minus(across, waist), times(height, plus(focal, growth)))
    level, half_slope, rise_value = value(c), value(growth), value(rise)
    steepness = value(across) + half_slope * half_slope  # square of half of the gradient of the level
    over = maximum(bottom - value(height), value(height) - top)
    error = position_error(splat(origin, like), rounded(f))
    within = error * error * (4.0 * steepness + error * error)  # square of the level at this distance from the side
    slack = where(((level <= 0.0) | (level * level <= within)) & (over <= error), error, 0.0)  # 0 off the surface
    on = (slack > 0.0) & (level * level <= within)
    # The square of the derivative of b by the place of the start.
    turning = 1.0 - rise_value * rise_value + value(spread) * value(spread)
    below, above, near = exact_ends(a, b, c, on, slack * slack * turning)
    low, high, per_rise = (bottom - height[0]) - height[1], (top - height[0]) - height[1], 1.0 / rise_value
    first, last = minimum(low * per_rise, high * per_rise), maximum(low * per_rise, high * per_rise)
    # A line that starts above a side or an end, if only by rounding, and gets beyond its rim stays outside.
    below = where(on & (near > last), near, below)
    starts = minimum(fabs(low), fabs(high)) <= slack
    # A line that starts above an end and is out of the side before it is below that end misses the solid.
    missed = (first > above) & (above > 0.0)
    first = where(starts & (fabs(first) <= fabs(last)) & ~missed, 0.0, first)
    last = where(starts & (fabs(last) < fabs(first)), 0.0, last)
    return Span(value(a), below, above, first, last, splat(1.0, like))


def exact_ends(a: Pair, b: Pair, c: Pair, on: Mask, error: Number) -> tuple[Number, Number, Number]:
    """Solve a t^2 + 2 b t + c = 0 as `negative_interval` does; if a line starts `on` the surface, the nearer end is 0.

    Returns the t at which the line falls below the surface, that at which it rises above, and the nearer end as it
    comes out of the equation, not set to 0. If b is 0 to rounding, the start lies midway between both ends, and both
    are 0 unless the line is steep: `error` is the square of the error of b.
    """
    a_value, b_value = value(a), value(b)
    both = on & (b_value * b_value <= error) & (a_value >= 0.0)
    b = where(both, 0.0, b[0]), where(both, 0.0, b[1])
    c = where(both, 0.0, c[0]), where(both, 0.0, c[1])
    D = value(minus(times(b, b), times(a, c)))
    q = -(value(b) + copysign(sqrt(D), value(b)))
    constant = where(both, 1.0, value(c))  # a line along the surface stays above it
    return *in_order(q, q / a_value, where(on, 0.0, value(c)) / q, a_value, constant), value(c) / q
