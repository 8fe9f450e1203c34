"""Compensated arithmetic: sums and products with their rounding errors, for where nearly everything cancels.

The pairs of a rounded result and its error are exact: two-sum (Moller 1965; Knuth 1969, The Art of Computer Programming
2, 4.2.2) and two-product (Dekker 1971, A Floating-Point Technique for Extending the Available Precision).
"""

from __future__ import annotations

from minirt.lanes import Vec, product_error, rounded_product
from minirt.lanes.vec import Number


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
