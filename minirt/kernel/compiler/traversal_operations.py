"""Compiled operations of BVH traversal: memory on the stack, and node references in the bits of distances."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from minirt.kernel import bvh_nodes
from minirt.kernel.shading import whitted
from minirt.lanes.compiled import memory
from minirt.lanes.compiled.types import Lanes, Mask, constant, register

INTEGER = ir.IntType(64)
LANES = Lanes(types.float64)
LANES_IR = ir.VectorType(ir.DoubleType(), LANES.count)
INTEGERS = ir.VectorType(INTEGER, LANES.count)
MEMORY = types.CPointer(types.float64)
CACHE_LINE = 64  # bytes; aligned to it, no load of lanes touches two lines


@register(bvh_nodes.packet_memory, lambda: MEMORY, [()])
def _packet_memory(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    memory = cgutils.alloca_once(builder, ir.DoubleType(), size=bvh_nodes.MEMORY)
    memory.align = CACHE_LINE
    return memory


@register(whitted.ray_stack, lambda: MEMORY, [()])
def _ray_stack(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return cgutils.alloca_once(builder, ir.DoubleType(), size=whitted.STACK_SIZE)


def address_at(context: Any, builder: ir.IRBuilder, sig: Any, args: Any, kind: ir.Type) -> Any:
    """Return the address of a value of some LLVM type that begins at an index of a memory."""
    place = builder.gep(args[0], [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.bitcast(place, kind.as_pointer())


@register(bvh_nodes.put, lambda memory, at, x: types.none, [(types.CPointer, types.Integer, Lanes)])
def _put(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    builder.store(args[2], address_at(context, builder, sig, args, LANES_IR), align=8)
    return context.get_dummy_value()


@register(bvh_nodes.integer_at, lambda memory, at: types.int64, [(types.CPointer, types.Integer)])
def _integer_at(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.load(address_at(context, builder, sig, args, INTEGER))


@register(bvh_nodes.put_integer, lambda memory, at, n: types.none, [(types.CPointer, types.Integer, types.Integer)])
def _put_integer(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    value = context.cast(builder, args[2], sig.args[2], types.int64)
    builder.store(value, address_at(context, builder, sig, args, INTEGER))
    return context.get_dummy_value()


@register(bvh_nodes.tag, lambda distance, references: LANES, [(Lanes, Lanes)])
def _tag(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    distance, references = (builder.bitcast(each, INTEGERS) for each in args)
    high = builder.and_(distance, constant(distance, ~bvh_nodes.REFERENCE_BITS))
    return builder.bitcast(builder.or_(high, references), LANES_IR)


@register(bvh_nodes.reference_of, lambda tagged: types.int64 if tagged == types.float64 else None, [(types.Float,)])
def _reference_of(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.sext(builder.trunc(builder.bitcast(args[0], INTEGER), ir.IntType(32)), INTEGER)


@register(bvh_nodes.bits, lambda mask: types.int64, [(Mask,)])
def _bits(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.zext(memory.bits(builder, args[0]), INTEGER)


@register(bvh_nodes.least_lane, lambda x: types.float64, [(Lanes,)])
def _least_lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    kind = ir.FunctionType(INTEGER, [INTEGERS])
    name = f"llvm.vector.reduce.smin.v{LANES.count}i64"
    minimum = cgutils.get_or_insert_function(builder.module, kind, name)
    return builder.bitcast(builder.call(minimum, [builder.bitcast(args[0], INTEGERS)]), ir.DoubleType())
