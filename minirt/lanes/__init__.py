"""Numbers that a kernel computes with.

A formula of a shape is written once, for one ray, with the operators of Python and the verbs of this package. What it
computes with is decided by who calls it:

- a test passes a numpy float64 (a Python float that divides by zero as IEEE 754 says) and gets the plain formula;
- interpreted, a kernel passes a numpy array of 16 float64 or 32 float32: one number for each ray of a packet;
- compiled, a kernel passes the same numbers as one vector of the processor, `f64x16` or `f32x32`
  (`minirt.lanes.compiled.types`).

So a number may stand for many, and a formula must not branch on one of them. `a < b` is a mask, one truth a ray;
masks combine with `&`, `|` and `~`; `where(mask, a, b)` chooses for each ray; `if any(mask):` skips work that no ray
needs. Nothing else in a formula shows that it runs on several rays at once.

This package is the interpreted half and imports no compiler; `minirt.lanes.compiled` teaches numba the same verbs.
"""

from minirt.lanes.operations import (
    any,
    copysign,
    exponent,
    fabs,
    first,
    floor,
    gather,
    greatest,
    inverse_root,
    lane,
    load,
    lowest,
    maximum,
    minimum,
    product_error,
    rarely,
    rounded_product,
    save,
    splat,
    sqrt,
    two_to,
    unit,
    unit_roundoff,
    where,
    width,
)
from minirt.lanes.vec import Vec, cross, dot

__all__ = [
    "Vec",
    "any",
    "copysign",
    "cross",
    "dot",
    "exponent",
    "fabs",
    "first",
    "floor",
    "gather",
    "greatest",
    "inverse_root",
    "lane",
    "load",
    "lowest",
    "maximum",
    "minimum",
    "product_error",
    "rarely",
    "rounded_product",
    "save",
    "splat",
    "sqrt",
    "two_to",
    "unit",
    "unit_roundoff",
    "where",
    "width",
]
