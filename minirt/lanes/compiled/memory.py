"""Arrays in memory, passed by reference; loads, stores and reductions of lanes, compiled."""

from __future__ import annotations

from math import inf
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import register_model

from minirt import lanes
from minirt.lanes import memory
from minirt.lanes.compiled.types import I32, Lanes, Mask, ValueModel, constant, llvm, register

ADDRESS = ir.IntType(8).as_pointer()
NUMBERS: dict[types.Type, int] = {}  # of types that are referred to: short, as they become parts of function names
DATA, SHAPE = 4, 5  # positions in numba's array structure: meminfo, parent, nitems, itemsize, data, shape, strides


class Reference(types.Type):
    """The address of a tuple or an array in memory; tuples and arrays in it are reached by reference too."""

    def __init__(self, content: types.BaseTuple | types.Array) -> None:
        self.content = content
        super().__init__(f"Reference{NUMBERS.setdefault(content, len(NUMBERS))}")
        self.llvm = ADDRESS


register_model(Reference)(ValueModel)


def array_of(kind: Any) -> types.Array | types.CPointer | None:
    """Return the type of an array, or of a row of one, which is the address of its first number; None for others."""
    kind = kind.content if isinstance(kind, Reference) else kind
    return kind if isinstance(kind, types.Array | types.CPointer) else None


def part_of(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, position: int) -> Any:
    """Return the address of an item of a tuple, or of a member of numba's array structure."""
    whole = context.get_value_type(kind.content).as_pointer()
    return cgutils.gep_inbounds(builder, builder.bitcast(value, whole), 0, position)


def first_of(context: Any, builder: ir.IRBuilder, kind: types.Type, values: Any) -> Any:
    """Return the address of the first number of an array."""
    if isinstance(kind, Reference):
        return builder.load(part_of(context, builder, kind, values, DATA))
    return values if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, value=values).data


def address(context: Any, builder: ir.IRBuilder, kinds: Any, values: Any, of: ir.Type) -> Any:
    """Return the address, at an index of an array, of a value of some LLVM type."""
    index = context.cast(builder, values[1], kinds[1], types.intp)
    place = builder.gep(first_of(context, builder, kinds[0], values[0]), [index])
    return builder.bitcast(place, of.as_pointer())


def load_type(values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of lanes that are loaded from an array, or from a row of one."""
    array = array_of(values)
    return Lanes(array.dtype) if array and isinstance(start, types.Integer) else None


@register(lanes.load, load_type)
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    place = address(context, builder, sig.args, args, context.get_value_type(sig.return_type))
    return builder.load(place, align=sig.return_type.number.bitwidth // 8)


def half_type(values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of the lanes that `load_half` loads."""
    lanes = load_type(values, start)
    return lanes and Lanes(lanes.number, lanes.count // 2)


@register(memory.load_half, half_type)
def _load_half(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return _load(context, builder, sig, args)


@register(memory.prefetch, lambda values, start: types.none if load_type(values, start) else None)
def _prefetch(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    place, integer = address(context, builder, sig.args, args, ir.IntType(8)), ir.IntType(32)
    kind = ir.FunctionType(ir.VoidType(), [ADDRESS, integer, integer, integer])
    function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
    builder.call(function, [place, *(ir.Constant(integer, each) for each in (0, 3, 1))])  # data to read, in all caches
    return context.get_dummy_value()


def save_type(x: types.Type, values: types.Type, start: types.Type) -> types.Type | None:
    """Return the type of no result, for lanes and an array or row of their numbers; None for other arguments."""
    return types.none if isinstance(x, Lanes) and x in (load_type(values, start), half_type(values, start)) else None


@register(lanes.save, save_type)
def _save(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    place = address(context, builder, sig.args[1:], args[1:], args[0].type)
    builder.store(args[0], place, align=sig.args[0].number.bitwidth // 8)
    return context.get_dummy_value()


def gather_type(values: types.Type, start: types.Type, indices: types.Type) -> types.Type | None:
    """Return the type of lanes that are gathered from an array: that of the indices."""
    return indices if load_type(values, start) and isinstance(indices, Lanes) else None


@register(lanes.gather, gather_type)
def _gather(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    lanes, number = sig.return_type, array_of(sig.args[0]).dtype  # type: ignore[union-attr]
    first = address(context, builder, sig.args, args, context.get_value_type(number))
    indices = builder.fptosi(args[2], ir.VectorType(I32, lanes.count))  # AVX2 converts no doubles to 64 bits
    loaded = ir.Constant(ir.VectorType(context.get_value_type(number), lanes.count), ir.Undefined)
    for i in range(lanes.count):
        lane = ir.Constant(I32, i)
        one = builder.load(builder.gep(first, [builder.extract_element(indices, lane)]))
        loaded = builder.insert_element(loaded, one, lane)
    target = context.get_value_type(lanes)
    if number == lanes.number:
        return loaded
    return (builder.fpext if number.bitwidth < lanes.number.bitwidth else builder.fptrunc)(loaded, target)


def width_type(x: types.Type) -> types.Type | None:
    """Return the type of the count of lanes of an array or of lanes."""
    return types.int64 if isinstance(x, Lanes) or array_of(x) else None


@register(lanes.width, width_type)
def _width(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    array = array_of(sig.args[0])
    return context.get_constant(types.int64, (Lanes(array.dtype) if array else sig.args[0]).count)


# Masks, and reductions of lanes.


def bits(builder: ir.IRBuilder, mask: Any) -> Any:
    """Return a mask as an integer with one bit for each lane."""
    return builder.bitcast(mask, ir.IntType(mask.type.count))


@register(lanes.bits, lambda mask: types.int64 if isinstance(mask, Mask) else None)
def _bits(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.zext(bits(builder, args[0]), ir.IntType(64))


@register(lanes.any, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None)
def _any(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    if sig.args[0] == types.boolean:
        return args[0]
    integer = bits(builder, args[0])
    return builder.icmp_unsigned("!=", integer, ir.Constant(integer.type, 0))


@register(lanes.rarely, lambda mask: types.boolean if isinstance(mask, (Mask, types.Boolean)) else None)
def _rarely(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    bit = ir.IntType(1)
    expect = builder.module.declare_intrinsic("llvm.expect", [bit], ir.FunctionType(bit, [bit, bit]))
    return builder.call(expect, [_any(context, builder, sig, args), ir.Constant(bit, 0)])


@register(lanes.first, lambda mask: types.int64 if isinstance(mask, Mask) else None)
def _first(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(builder.zext(bits(builder, args[0]), ir.IntType(64)), ir.Constant(ir.IntType(1), 1))


@register(lanes.greatest, lambda x: x.number if isinstance(x, Lanes) else None)
def _greatest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    least = constant(args[0], -inf)
    return reduced(builder, "fmax", builder.select(builder.fcmp_ordered(">", args[0], least), args[0], least))


def reduced(builder: ir.IRBuilder, operation: str, lanes: Any) -> Any:
    """Reduce lanes, none of which is NaN, to one number by LLVM's "fmin" or "fmax"."""
    return llvm(builder, f"vector.reduce.{operation}", lanes, result=lanes.type.element, flags=("nnan",))


@register(lanes.lowest, lambda number: types.int64 if number == types.int64 else None)
def _lowest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))
