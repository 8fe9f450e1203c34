"""Loads, stores and reductions of lanes, compiled."""

from __future__ import annotations

from math import inf
from typing import Any

from llvmlite import ir
from numba import types

from minirt import lanes
from minirt.lanes.compiled.types import ANY, I32, Lanes, Mask, constant, register


def load_type(values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of lanes that are loaded from an array, or from a row of one."""
    if not (isinstance(values, types.Array | types.CPointer) and isinstance(start, types.Integer)):
        return None
    return Lanes(values.dtype)


def address(context: Any, builder: ir.IRBuilder, kind: types.Type, values: Any) -> Any:
    """Return the address of the first number of an array, or of a row, which is that address."""
    return values if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, value=values).data


@register(lanes.load, load_type, [(types.Array, types.Integer), (types.CPointer, types.Integer)])
def load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Emit the load of lanes that lie one after the other."""
    values = address(context, builder, sig.args[0], args[0])
    place = builder.gep(values, [context.cast(builder, args[1], sig.args[1], types.intp)])
    lanes = context.get_value_type(sig.return_type)
    return builder.load(builder.bitcast(place, lanes.as_pointer()), align=sig.return_type.number.bitwidth // 8)


def gather_type(values: types.Type, indices: types.Type) -> types.Type | None:
    """Return the type of lanes that are gathered from an array: that of the indices."""
    return indices if isinstance(values, types.Array) and isinstance(indices, Lanes) else None


@register(lanes.gather, gather_type, [(types.Array, Lanes)])
def gather(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Emit a load for each lane, and the conversion of all to the precision of the indices."""
    values = context.make_array(sig.args[0])(context, builder, value=args[0])
    lanes = sig.return_type
    stored = ir.VectorType(context.get_value_type(sig.args[0].dtype), lanes.count)
    indices = builder.fptosi(args[1], ir.VectorType(ir.IntType(64), lanes.count))
    loaded = ir.Constant(stored, ir.Undefined)
    for i in range(lanes.count):
        lane = ir.Constant(ir.IntType(32), i)
        number = builder.load(builder.gep(values.data, [builder.extract_element(indices, lane)]))
        loaded = builder.insert_element(loaded, number, lane)
    target = context.get_value_type(lanes)
    if stored == target:
        return loaded
    is_narrower = sig.args[0].dtype.bitwidth < lanes.number.bitwidth
    return builder.fpext(loaded, target) if is_narrower else builder.fptrunc(loaded, target)


def save_type(x: types.Type, values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of no result, for lanes and an array or row of their numbers; None for other arguments."""
    return types.none if isinstance(values, types.Array | types.CPointer) and x == Lanes(values.dtype) else None


@register(lanes.save, save_type, [(Lanes, types.Array, types.Integer), (Lanes, types.CPointer, types.Integer)])
def _save(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = address(context, builder, sig.args[1], args[1])
    place = builder.gep(values, [context.cast(builder, args[2], sig.args[2], types.intp)])
    builder.store(args[0], builder.bitcast(place, args[0].type.as_pointer()), align=sig.args[0].number.bitwidth // 8)
    return context.get_dummy_value()


def bits(builder: ir.IRBuilder, mask: Any) -> Any:
    """Return a mask as an integer with one bit for each lane."""
    return builder.bitcast(mask, ir.IntType(mask.type.count))


@register(lanes.any, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None, [(ANY,)])
def _any(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    if sig.args[0] == types.boolean:
        return args[0]
    integer = bits(builder, args[0])
    return builder.icmp_unsigned("!=", integer, ir.Constant(integer.type, 0))


@register(lanes.rarely, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None, [(ANY,)])
def _rarely(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    bit = ir.IntType(1)
    expect = builder.module.declare_intrinsic("llvm.expect", [bit], ir.FunctionType(bit, [bit, bit]))
    return builder.call(expect, [_any(context, builder, sig, args), ir.Constant(bit, 0)])


@register(lanes.first, lambda mask: types.int64 if isinstance(mask, Mask) else None, [(Mask,)])
def _first(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(builder.zext(bits(builder, args[0]), ir.IntType(64)), ir.Constant(ir.IntType(1), 1))


@register(lanes.greatest, lambda x: x.number if isinstance(x, Lanes) else None, [(Lanes,)])
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


@register(lanes.lowest, lambda number: types.int64 if number == types.int64 else None, [(types.Integer,)])
def _lowest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))
