"""Exponents of numbers by their bits, as IEEE 754 lays them out, and the rounding error of a product; compiled."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations
from minirt.lanes.compiled.registration import one_number, register, same_numbers, single, two_numbers
from minirt.lanes.compiled.types import constant, llvm

ANY = types.Any
# By the size of a number in bits: the bits of its fraction, and what is added to its exponent before it is stored.
FRACTION_BITS = {64: 52, 32: 23}
BIAS = {64: 1023, 32: 127}
ROUNDOFF = {64: 2.0**-53, 32: 2.0**-24}  # unit roundoff


def integer_layout(number: types.Float, like: Any) -> tuple[ir.Type, int, int]:
    """Return the LLVM type of the bits of `like`, of numbers of a type, and their count of fraction bits and bias."""
    integer = ir.IntType(number.bitwidth)
    is_vector = isinstance(like.type, ir.VectorType)
    kind = ir.VectorType(integer, like.type.count) if is_vector else integer
    return kind, FRACTION_BITS[number.bitwidth], BIAS[number.bitwidth]


@register(operations.exponent, one_number, [(ANY,)])
def _exponent(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    integers, fraction, bias = integer_layout(single(sig.return_type), x)
    stored = builder.bitcast(x, integers)
    stored = builder.lshr(stored, constant(stored, fraction))
    return builder.sitofp(builder.sub(stored, constant(stored, bias)), x.type)


@register(operations.two_to, one_number, [(ANY,)])
def _two_to(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    integers, fraction, bias = integer_layout(single(sig.return_type), x)
    bounded = llvm(builder, "maxnum", x, constant(x, float(-bias)))
    whole = builder.fptosi(bounded, integers)
    stored = builder.shl(builder.add(whole, constant(whole, bias)), constant(whole, fraction))
    return builder.bitcast(stored, x.type)


@register(operations.unit_roundoff, single, [(ANY,)])
def _unit_roundoff(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(sig.return_type, ROUNDOFF[sig.return_type.bitwidth])


@register(operations.rounded_product, two_numbers, [(ANY, ANY)])
def _rounded_product(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    # Without the fence the flags of the kernel allow fusing the product with a sum that follows.
    return llvm(builder, "arithmetic.fence", builder.fmul(*same_numbers(context, builder, sig, args)))


@register(operations.product_error, two_numbers, [(ANY, ANY)])
def _product_error(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = same_numbers(context, builder, sig, args)
    return llvm(builder, "fma", a, b, builder.fneg(builder.fmul(a, b)))
