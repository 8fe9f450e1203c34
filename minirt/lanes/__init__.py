"""SIMD lanes: numbers that stand for one ray or for a packet of rays, and the operations on them.

A formula of a shape is written once, for one ray, with the operators of Python and the operations of this package. Its
caller decides on the numbers:

- a test passes a numpy float64 (a Python float that divides by zero as IEEE 754 says) and gets the plain formula;
- an interpreted kernel passes a numpy array of 16 float64 or 32 float32, one number for each ray of a packet;
- a compiled kernel passes the same numbers as one SIMD vector, `f64x16` or `f32x32` (`minirt.lanes.compiled.types`).

A number may stand for many, so a formula must not branch on it. `a < b` is a mask, a truth value for each ray; masks
combine with `&`, `|` and `~`; `where(mask, a, b)` selects for each ray; `if any(mask):` skips work that no ray needs.
Nothing else in a formula shows that it runs on several rays at once.

This package is the interpreted half and imports no compiler; `minirt.lanes.compiled` registers the same operations with
numba.
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
