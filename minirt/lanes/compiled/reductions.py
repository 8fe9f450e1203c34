"""Reductions, compiled: operations that make one value of all lanes or of a mask."""

from __future__ import annotations

from math import inf
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations
from minirt.lanes.compiled.registration import register
from minirt.lanes.compiled.types import I32, Lanes, Mask, constant

ANY = types.Any


def bits(builder: ir.IRBuilder, mask: Any) -> Any:
    """Return a mask as an integer with one bit for each lane."""
    return builder.bitcast(mask, ir.IntType(mask.type.count))


@register(operations.any, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None, [(ANY,)])
def _any(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    if sig.args[0] == types.boolean:
        return args[0]
    integer = bits(builder, args[0])
    return builder.icmp_unsigned("!=", integer, ir.Constant(integer.type, 0))


@register(operations.rarely, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None, [(ANY,)])
def _rarely(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    bit = ir.IntType(1)
    expect = builder.module.declare_intrinsic("llvm.expect", [bit], ir.FunctionType(bit, [bit, bit]))
    return builder.call(expect, [_any(context, builder, sig, args), ir.Constant(bit, 0)])


@register(operations.first, lambda mask: types.int64 if isinstance(mask, Mask) else None, [(Mask,)])
def _first(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(builder.zext(bits(builder, args[0]), ir.IntType(64)), ir.Constant(ir.IntType(1), 1))


@register(operations.greatest, lambda x: x.number if isinstance(x, Lanes) else None, [(Lanes,)])
def _greatest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    best = constant(args[0], -inf)
    best = builder.select(builder.fcmp_ordered(">", args[0], best), args[0], best)
    count = best.type.count
    while count > 1:  # the greater of each lane and the lane half a vector further on
        count //= 2
        halves = (ir.Constant(ir.VectorType(I32, count), [*range(start, start + count)]) for start in (0, count))
        low, high = (builder.shuffle_vector(best, best, half) for half in halves)
        best = builder.select(builder.fcmp_ordered(">", low, high), low, high)
    return builder.extract_element(best, ir.Constant(I32, 0))


@register(operations.lowest, lambda number: types.int64 if number == types.int64 else None, [(types.Integer,)])
def _lowest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))
