"""Loads and stores of lanes, compiled: load, gather and save."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations
from minirt.lanes.compiled.registration import register
from minirt.lanes.compiled.types import Lanes


def load_type(values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of lanes that are loaded from an array, or from a row of one."""
    if not (isinstance(values, types.Array | types.CPointer) and isinstance(start, types.Integer)):
        return None
    return Lanes(values.dtype)


def address(context: Any, builder: ir.IRBuilder, kind: types.Type, values: Any) -> Any:
    """Return the address of the first number of an array, or of a row, which is that address."""
    return values if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, value=values).data


@register(operations.load, load_type, [(types.Array, types.Integer), (types.CPointer, types.Integer)])
def load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Emit the load of lanes that lie one after the other."""
    values = address(context, builder, sig.args[0], args[0])
    place = builder.gep(values, [context.cast(builder, args[1], sig.args[1], types.intp)])
    lanes = context.get_value_type(sig.return_type)
    return builder.load(builder.bitcast(place, lanes.as_pointer()), align=sig.return_type.number.bitwidth // 8)


def gather_type(values: types.Type, indices: types.Type) -> types.Type | None:
    """Return the type of lanes that are gathered from an array: that of the indices."""
    return indices if isinstance(values, types.Array) and isinstance(indices, Lanes) else None


@register(operations.gather, gather_type, [(types.Array, Lanes)])
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


@register(operations.save, save_type, [(Lanes, types.Array, types.Integer), (Lanes, types.CPointer, types.Integer)])
def _save(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = address(context, builder, sig.args[1], args[1])
    place = builder.gep(values, [context.cast(builder, args[2], sig.args[2], types.intp)])
    builder.store(args[0], builder.bitcast(place, args[0].type.as_pointer()), align=sig.args[0].number.bitwidth // 8)
    return context.get_dummy_value()
