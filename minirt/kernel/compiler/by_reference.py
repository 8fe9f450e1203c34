"""Passing a scene by reference: one address in place of all its arrays.

numba passes a tuple as all the numbers in it, and an array is seven of them or more: a scene took a hundred and more
in each call, and taking it apart and putting it together was most of the code to compile. Reading through a reference
also takes fewer instructions, as indices are not negative and the rows of an array lie one after the other.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import lower_getattr_generic

from minirt.kernel import trace
from minirt.lanes.compiled.memory import ADDRESS, SHAPE, Reference, first_of, part_of
from minirt.lanes.compiled.types import register


def is_array(kind: Any) -> bool:
    """Whether a type is a reference to an array."""
    return isinstance(kind, Reference) and isinstance(kind.content, types.Array)


def item_type(kind: Reference, position: int) -> types.Type:
    """Return the type of an item of a tuple: of a number, or of a reference to an array or to another tuple."""
    item = kind.content[position]
    return Reference(item) if isinstance(item, types.BaseTuple | types.Array) else item


def item_of(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, position: int) -> Any:
    """Return an item of a tuple: a number, or a reference."""
    address = part_of(context, builder, kind, value, position)
    is_reference = isinstance(item_type(kind, position), Reference)
    return builder.bitcast(address, ADDRESS) if is_reference else builder.load(address)


@infer_getattr
class ReferenceFields(AttributeTemplate):
    """Types of the fields of a NamedTuple, and of the shape of an array."""

    key = Reference

    def generic_resolve(self, kind: Reference, name: str) -> types.Type:
        """Return the type of a field."""
        if is_array(kind):
            return types.UniTuple(types.intp, kind.content.ndim) if name == "shape" else None
        return item_type(kind, kind.content.fields.index(name))


@lower_getattr_generic(Reference)  # type: ignore[untyped-decorator]
def _field(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, name: str) -> Any:
    if is_array(kind):
        return builder.load(part_of(context, builder, kind, value, SHAPE))
    return item_of(context, builder, kind, value, kind.content.fields.index(name))


# Arrays: reading and writing items.

INDEXED = [(Reference, types.Integer), (Reference, types.BaseTuple)]


def length(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, axis: int) -> Any:
    """Return the length of an array along an axis."""
    shape = part_of(context, builder, kind, value, SHAPE)
    return builder.load(cgutils.gep_inbounds(builder, shape, 0, axis))


def element_type(table: Any, index: Any) -> types.Type | None:
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
    return builder.gep(first_of(context, builder, table, args[0]), [at])


@register(operator.getitem, element_type, INDEXED)
def _get_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    address = address_of_item(context, builder, sig, args)
    return address if isinstance(sig.return_type, types.CPointer) else builder.load(address)


def no_result(table: Any, index: Any, value: Any) -> types.Type | None:
    """Return the type of no result for an index to which a number can be assigned; None for any other."""
    return types.none if is_array(table) and element_type(table, index) == table.content.dtype else None


@register(operator.setitem, no_result, [(*each, types.Any) for each in INDEXED])
def _set_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    value = context.cast(builder, args[2], sig.args[2], sig.args[0].content.dtype)
    builder.store(value, address_of_item(context, builder, sig, args))
    return context.get_dummy_value()


# The loop over the kinds of shapes, unrolled at compile time.


def step_signatures(step: Any, groups: Reference, state: Any, arguments: Any) -> list[Any]:
    """Return the signature of the step for each kind."""
    signatures = []
    for position in range(len(groups.content)):
        kinds = item_type(groups, position), state, arguments
        signatures.append(cpu_target.typing_context.resolve_function_type(step, kinds, {}))
        state = signatures[-1].return_type
    return signatures


@register(trace.for_each_kind, lambda *kinds: step_signatures(*kinds)[-1].return_type)
def _for_each_kind(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    _, groups, state, arguments = args
    kind = sig.args[2]
    for position, each in enumerate(step_signatures(*sig.args)):
        function = context.get_function(sig.args[0], each)
        context.add_linking_libs(getattr(function, "libs", ()))
        state = context.cast(builder, state, kind, each.args[1])
        state = function(builder, (item_of(context, builder, sig.args[1], groups, position), state, arguments))
        kind = each.return_type
    return state
