"""Compiled reading of packed shapes: rows of record arrays, loaded number by number.

A packed shape is the NamedTuple of its kind; its numbers and Vecs lie in a row one after the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import Any

from llvmlite import ir
from numba import types

from minirt.kernel import scene_arrays
from minirt.kernel.compiler.arrays_by_reference import register_by_reference
from minirt.lanes.compiled.types import VecType, common, register, vec_of


def address_of_row(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Return the address of the first number of a row."""
    array = context.make_array(sig.args[0])(context, builder, value=args[0])
    place = builder.gep(array.data, [context.cast(builder, args[1], sig.args[1], types.intp)])
    number = context.get_value_type(common(*number_types(sig.args[0])))
    return builder.bitcast(place, number.as_pointer())


def number_types(array: Any) -> list[Any]:
    """Return the types of the numbers in the fields of a row; all are the same."""
    kinds = [each.type for each in array.dtype.fields.values()]
    return [kind.dtype if isinstance(kind, types.NestedArray) else kind for kind in kinds]


def packed_type(array: Any, i: Any) -> Any:
    """Return the type of a packed shape: the NamedTuple of its kind, of numbers and Vecs."""
    if not isinstance(array, types.Array):
        return None
    number = common(*number_types(array))
    fields = [
        VecType(number) if isinstance(each.type, types.NestedArray) else number for each in array.dtype.fields.values()
    ]
    return types.NamedTuple(fields, scene_arrays.kind_of(array.dtype.fields).packed)


@register(scene_arrays.read, packed_type, [(types.Array, types.Integer)])
def _read(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    address = address_of_row(context, builder, sig, args)
    numbers = (builder.load(builder.gep(address, [ir.Constant(ir.IntType(64), at)])) for at in count())
    return packed_of(context, builder, sig.return_type, numbers)


def packed_of(context: Any, builder: ir.IRBuilder, kind: Any, numbers: Iterator[Any]) -> Any:
    """Return the packed shape of a type, made of its numbers in their order."""
    parts = [
        vec_of(context, builder, each, [next(numbers) for _ in "xyz"]) if isinstance(each, VecType) else next(numbers)
        for each in kind.types
    ]
    return context.make_tuple(builder, kind, parts)


register_by_reference(scene_arrays.read, packed_type, _read)
