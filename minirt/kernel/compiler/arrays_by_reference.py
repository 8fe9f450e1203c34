"""Arrays that are passed by reference: reading and writing items, and operations that read whole arrays."""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import signature

from minirt import lanes
from minirt.kernel.compiler.by_reference import DATA, SHAPE, Reference, address_of_part, is_array
from minirt.lanes.compiled import memory
from minirt.lanes.compiled.types import Result, register

INDEXED = [(Reference, types.Integer), (Reference, types.BaseTuple)]


def data(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any) -> Any:
    """Return the address of the first number of an array."""
    return builder.load(address_of_part(context, builder, kind, value, DATA))


def length(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, axis: int) -> Any:
    """Return the length of an array along an axis."""
    shape = address_of_part(context, builder, kind, value, SHAPE)
    return builder.load(cgutils.gep_inbounds(builder, shape, 0, axis))


def item_type(table: Any, index: Any) -> types.Type | None:
    """Return the type of an item: a number, or a pointer to a row where the last coordinate is left out."""
    if not is_array(table):
        return None
    coordinates = len(index) if isinstance(index, types.BaseTuple) else 1
    return table.content.dtype if coordinates == table.content.ndim else types.CPointer(table.content.dtype)


def address_of_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Return the address of the item at an index."""
    table, kind = sig.args[:2]
    is_tuple = isinstance(kind, types.BaseTuple)
    kinds = kind if is_tuple else [kind]
    values = [builder.extract_value(args[1], i) for i in range(len(kinds))] if is_tuple else [args[1]]
    at, *others = [context.cast(builder, *each, types.intp) for each in zip(values, kinds, strict=True)]
    for axis in range(1, table.content.ndim):
        at = builder.mul(at, length(context, builder, table, args[0], axis))
        if others:
            at = builder.add(at, others.pop(0))
    return builder.gep(data(context, builder, table, args[0]), [at])


@register(operator.getitem, item_type, INDEXED)
def _get_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    address = address_of_item(context, builder, sig, args)
    return address if isinstance(sig.return_type, types.CPointer) else builder.load(address)


def no_result(table: Any, index: Any, value: Any) -> types.Type | None:
    """Return the type of no result for an index to which a number can be assigned; None for any other."""
    return types.none if is_array(table) and item_type(table, index) == table.content.dtype else None


@register(operator.setitem, no_result, [(*each, types.Any) for each in INDEXED])
def _set_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    value = context.cast(builder, args[2], sig.args[2], sig.args[0].content.dtype)
    builder.store(value, address_of_item(context, builder, sig, args))
    return context.get_dummy_value()


def register_by_reference(function: Any, result: Result, generate: Any) -> None:
    """Let an operation whose first argument is an array take a reference to one."""

    def result_by_reference(table: Any, *others: Any) -> types.Type | None:
        return result(table.content, *others) if is_array(table) else None

    @register(function, result_by_reference, [(Reference, types.Any), (Reference, types.Any, types.Any)])
    def _generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        kind = sig.args[0].content
        array = builder.load(builder.bitcast(args[0], context.get_value_type(kind).as_pointer()))
        return generate(context, builder, signature(sig.return_type, kind, *sig.args[1:]), [array, *args[1:]])


register_by_reference(lanes.load, memory.load_type, memory.load)
register_by_reference(lanes.gather, memory.gather_type, memory.gather)
