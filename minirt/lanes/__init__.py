"""Numbers that a kernel computes with.

A formula of a shape is written once, for one ray, with the operators of Python and the verbs of this package. What it
computes with is decided by who calls it:

- a test passes a numpy float64 (a Python float that divides by zero as IEEE 754 says) and gets the plain formula;
- interpreted, a kernel passes a numpy array of `WIDTH` float64: one number for each of `WIDTH` rays;
- compiled, a kernel passes the same `WIDTH` numbers as one vector of the processor (`minirt.lanes.vector`).

So a number may stand for many, and a formula must not branch on one of them. `a < b` is a mask, one truth a ray;
masks combine with `&`, `|` and `~`; `where(mask, a, b)` chooses for each ray; `if any(mask):` skips work that no ray
needs. Nothing else in a formula shows that it runs on several rays at once.

This package is the interpreted half and imports no compiler; `minirt.lanes.compiled` teaches numba the same verbs.
"""

from minirt.lanes.vec import Vec, dot
from minirt.lanes.verbs import (
    WIDTH,
    any,
    copysign,
    fabs,
    first,
    floor,
    lane,
    load,
    maximum,
    minimum,
    product_error,
    rounded_product,
    splat,
    sqrt,
    where,
)

__all__ = [
    "WIDTH",
    "Vec",
    "any",
    "copysign",
    "dot",
    "fabs",
    "first",
    "floor",
    "lane",
    "load",
    "maximum",
    "minimum",
    "product_error",
    "rounded_product",
    "splat",
    "sqrt",
    "where",
]
