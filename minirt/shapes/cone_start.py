"""Rays that start on a cone, or close to it on the scale of the cone: their quadratic equation, without cancellation.

Three places need care, besides that of all quadrics (`minirt.shapes.start`).

A ray beside a generator. From a start at the side nearly everything cancels in a and b, and in the farther end, about
-2 b / a. From the height of the apex that end is exact, and b follows from both ends, of which the nearer one is c / a
by the farther one. If both ends are about as far away the ray passes the apex so closely that the discriminant cancels,
and if the nearer end is about as far away as the apex b is known too badly: then t is counted from the height of the
apex alone.

The neighbourhood of the apex. Rounding decides there whether a ray touches the side, and one that starts outside must
not hit where it starts: it passes the side unless it meets a cone which is thinner by some roundings of the distance.

A start within its own rounding of both ends, as of the apex, is on both: both are at t = 0 for a ray that is steeper
than the side, and any other ray touches the side there and misses. So does one from the side towards the apex with
a = 0: the level, which is linear then, is 0 at its start and not negative at the height of the apex, hence nowhere
between; rounding alone may deny that.
"""

from __future__ import annotations

from typing import Any

from minirt.lanes import (
    Mask,
    Number,
    Vec,
    copysign,
    fabs,
    max_norm,
    maximum,
    minimum,
    splat,
    sqrt,
    unit_roundoff,
    where,
)
from minirt.shapes.compensated import minus, times, value
from minirt.shapes.quadric import clamped_minimum
from minirt.shapes.start import axial, beside_side, between_caps, error_of_start, position_error, zero_within

PARALLEL = 2.0**-6  # share of a steepness by which that of a ray beside a generator differs
SHELL = 2.0**13  # unit roundoffs of the size of a cone, a shell of that thickness at the apex is close to it
BLUNT = 2.0**-14  # share of the height within which the apex is blunt; its square for rays beside generators
BLUR = 16.0  # unit roundoffs of the distance from the apex by which the cone is thinner there


def apex_shell(slope: float, size: float, like: Number) -> float:
    """Return the square of a distance from the axis below which a ray starts close to the apex, wherever its side is.

    In a shell of 64 roundings around the side the square of the distance exceeds that of the side by much of itself.
    """
    thick = SHELL * unit_roundoff(like) * (1.0 + slope) * size
    return thick * thick


def close_start(
    cone: Any,
    origin: Vec,
    p: Vec,
    d: Vec,
    close: Mask,
    parallel: Mask,
    a: Number,
    per_a: Number,
    b: Number,
    level: Number,
    over: Number,
    per_height: Number,
    start: Number,
    tip_b: Number,
    tip_c: Number,
) -> tuple[Number, Number, Number, Number, Number, Number]:
    """Return for `close` rays t at the first and at the last cap, and where t is counted from; there b, c and product.

    `parallel` rays are beside a generator: `start` is the height of the apex, where b and c are `tip_b` and `tip_c`.
    """
    reach, rise = cone.slope * p.z, cone.slope * d.z
    squared = reach * reach
    height, power = axial(origin, cone.apex, cone.w, cone.w_low, a)
    side = times((splat(cone.slope, a), splat(cone.slope_low, a)), height)  # its distance from the axis
    exact_level = value(minus(power, times(side, side)))
    slope = sqrt(squared * (1.0 + cone.slope * cone.slope))
    away, position = max_norm(p), position_error(origin, p)
    on_apex = close & (away <= position)
    error = where(on_apex, position, error_of_start(origin, p, level, slope, over))
    rounding = 2.0 * slope * error
    first, last = between_caps(height, 0.0, cone.height, per_height, error)
    clear = zero_within(exact_level, minimum(rounding, BLUNT * squared))
    alike = fabs(a * clear) > 4.0 * PARALLEL * (b * b)  # both ends are about as far away
    distant = fabs(clear) > PARALLEL * fabs(b) * away  # the nearer end is about as far away as the apex, or farther
    beside = close & beside_side(level, squared, over, 0.5 * cone.height) & ~(parallel & (alike | distant))
    far = farther_end(a, per_a, start, tip_b, tip_c)
    start = where(beside, 0.0, where(close & ~parallel, clamped_minimum(per_a, b, first, last), start))
    q = p + start * d
    reach_q = cone.slope * where(beside, height[0], q.z)
    half_b = q.x * d.x + q.y * d.y - reach_q * rise
    known = beside & parallel & (fabs(clear) < PARALLEL * fabs(a) * far * far) & (fabs(far) > error)
    half_b = where(known, -0.5 * (a * far + exact_level / far), half_b)
    c = where(beside, exact_level, q.x * q.x + q.y * q.y - reach_q * reach_q)
    on_side = beside & (fabs(c) <= rounding)
    product = where(on_side, 0.0, c)
    blunt = close & (away <= where(parallel, BLUNT * BLUNT, BLUNT) * cone.height)
    blur = where(blunt, BLUR * unit_roundoff(a) * (1.0 + cone.slope) * away, 0.0)
    c = c + blur * (2.0 * fabs(where(parallel, reach, reach_q)) + blur)
    half_b = zero_within(half_b, maximum(blur * fabs(rise), where(on_side, fabs(a) * error, 0.0)))
    on_both = on_apex | (on_side & ((half_b == 0.0) | ((a == 0.0) & (d.z < 0.0))))
    start, half_b = where(on_apex, 0.0, start), where(on_both, 0.0, half_b)
    return first, last, start, half_b, where(on_both, where(a < 0.0, 0.0, 1.0), c), where(on_both, 0.0, product)


def farther_end(a: Number, per_a: Number, tip: Number, b: Number, c: Number) -> Number:
    """Return the root of a ray's quadratic equation that is farther from its start, 0 where it has none.

    t is counted from the start, and b and c are those at `tip`.
    """
    q = -(b + copysign(sqrt(b * b - a * c), b))
    one, other = tip + q * per_a, tip + c / q
    return where(fabs(q) > 0.0, where(fabs(one) > fabs(other), one, other), 0.0)
