"""Where the compiler learns to pass a scene by its address.

numba passes a tuple as all the numbers in it, and an array is seven of them or more: a scene took a hundred and more
in each call, and taking it apart and putting it together was most of what there was to compile. What lies in memory is
also read with fewer instructions, as its indices are not negative and its rows lie one after the other.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import lower_builtin, lower_getattr_generic, register_model

from minirt.kernel import scene_arrays, trace
from minirt.lanes import operations
from minirt.lanes.compiled import operations as compiled_operations
from minirt.lanes.compiled.registration import Result, register

ADDRESS = ir.IntType(8).as_pointer()
DATA, SHAPE = 4, 5  # of an array, in the order in which numba keeps them


class Placed(types.Type):
    """A tuple or an array that lies in memory, and so does what is in it."""

    def __init__(self, content: types.BaseTuple | types.Array) -> None:
        self.content = content
        super().__init__(f"Placed{content._code}")  # short: it becomes a part of the names of functions


@register_model(Placed)
class PlacedModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Placed) -> None:
        super().__init__(manager, kind, ADDRESS)


def can_be_placed(kind: Any) -> bool:
    """Tuples, and arrays whose rows lie one after the other."""
    return isinstance(kind, types.BaseTuple) or (isinstance(kind, types.Array) and kind.layout == "C")


@register(scene_arrays.by_reference, lambda kind: Placed(kind) if can_be_placed(kind) else None, [(types.Any,)])
def _placed(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.bitcast(cgutils.alloca_once_value(builder, args[0]), ADDRESS)


def part(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, place: int) -> Any:
    """The address of a part of a tuple, or of what numba keeps of an array."""
    whole = context.get_value_type(kind.content).as_pointer()
    return cgutils.gep_inbounds(builder, builder.bitcast(value, whole), 0, place)


def is_array(kind: Any) -> bool:
    """Whether that is an array in memory."""
    return isinstance(kind, Placed) and isinstance(kind.content, types.Array)


# Tuples.


def kind_at(kind: Placed, place: int) -> types.Type:
    """The type of a part."""
    found = kind.content[place]
    return Placed(found) if can_be_placed(found) else found


def value_at(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, place: int) -> Any:
    """A part."""
    address = part(context, builder, kind, value, place)
    return builder.bitcast(address, ADDRESS) if isinstance(kind_at(kind, place), Placed) else builder.load(address)


@infer_getattr
class PlacedFields(AttributeTemplate):
    """The types of the fields of a NamedTuple, and of the shape of an array."""

    key = Placed

    def generic_resolve(self, kind: Placed, name: str) -> types.Type:
        if is_array(kind):
            return types.UniTuple(types.intp, kind.content.ndim) if name == "shape" else None
        return kind_at(kind, kind.content.fields.index(name))


@lower_getattr_generic(Placed)  # type: ignore[untyped-decorator]
def _field(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, name: str) -> Any:
    if is_array(kind):
        return builder.load(part(context, builder, kind, value, SHAPE))
    return value_at(context, builder, kind, value, kind.content.fields.index(name))


@register(len, lambda table: types.intp if isinstance(table, Placed) else None, [(Placed,)])
def _len(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(types.intp, len(sig.args[0].content))


@infer_global(trace.for_each_kind)
class OverKinds(AbstractTemplate):
    """The type of `over_kinds`: that of the state after the last step."""

    key = trace.for_each_kind

    def generic(self, args: Any, kws: Any) -> Any:
        return signature(steps_of(self.context, *args)[-1].return_type, *args)


def steps_of(context: Any, step: Any, groups: Placed, state: Any, given: Any) -> list[Any]:
    """The signature of the step for each kind."""
    found = []
    for place in range(len(groups.content)):
        found.append(context.resolve_function_type(step, (kind_at(groups, place), state, given), {}))
        state = found[-1].return_type
    return found


@lower_builtin(trace.for_each_kind, types.Any, Placed, types.Any, types.Any)  # type: ignore[untyped-decorator]
def _over_kinds(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    _, groups, state, given = args
    kind = sig.args[2]
    for place, each in enumerate(steps_of(context.typing_context, *sig.args)):
        function = context.get_function(sig.args[0], each)
        context.add_linking_libs(getattr(function, "libs", ()))
        state = context.cast(builder, state, kind, each.args[1])
        state = function(builder, (value_at(context, builder, sig.args[1], groups, place), state, given))
        kind = each.return_type
    return state


# Arrays.


def data(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any) -> Any:
    """The address of the first number."""
    return builder.load(part(context, builder, kind, value, DATA))


def length(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, axis: int) -> Any:
    """How many rows, columns or whatever there are along an axis."""
    return builder.load(cgutils.gep_inbounds(builder, part(context, builder, kind, value, SHAPE), 0, axis))


def item(table: Any, index: Any) -> types.Type | None:
    """The type of what is at an index: a number, or a row where the last coordinate is not given."""
    if not is_array(table):
        return None
    given = len(index) if isinstance(index, types.BaseTuple) else 1
    return table.content.dtype if given == table.content.ndim else types.CPointer(table.content.dtype)


INDEXED = [(Placed, types.Integer), (Placed, types.BaseTuple)]


def place_of(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """The address of what is at an index."""
    table, kind = sig.args[:2]
    several = isinstance(kind, types.BaseTuple)
    kinds = kind if several else [kind]
    whole = [builder.extract_value(args[1], i) for i in range(len(kinds))] if several else [args[1]]
    at, *others = [context.cast(builder, *each, types.intp) for each in zip(whole, kinds, strict=True)]
    for axis in range(1, table.content.ndim):
        at = builder.mul(at, length(context, builder, table, args[0], axis))
        if others:
            at = builder.add(at, others.pop(0))
    return builder.gep(data(context, builder, table, args[0]), [at])


@register(operator.getitem, item, INDEXED)
def _item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    address = place_of(context, builder, sig, args)
    return address if isinstance(sig.return_type, types.CPointer) else builder.load(address)


def nothing(table: Any, index: Any, value: Any) -> types.Type | None:
    """The type of no result, where a number can be put."""
    return types.none if is_array(table) and item(table, index) == table.content.dtype else None


@register(operator.setitem, nothing, [(*each, types.Any) for each in INDEXED])
def _set_item(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    value = context.cast(builder, args[2], sig.args[2], sig.args[0].content.dtype)
    builder.store(value, place_of(context, builder, sig, args))
    return context.get_dummy_value()


def teach_for_placed(function: Any, result: Result, generate: Any) -> None:
    """A verb that reads an array reads one in memory."""

    def found(table: Any, *others: Any) -> types.Type | None:
        return result(table.content, *others) if is_array(table) else None

    @register(function, found, [(Placed, types.Any), (Placed, types.Any, types.Any)])
    def _read(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        kind = sig.args[0].content
        array = builder.load(builder.bitcast(args[0], context.get_value_type(kind).as_pointer()))
        return generate(context, builder, signature(sig.return_type, kind, *sig.args[1:]), [array, *args[1:]])


teach_for_placed(operations.load, compiled_operations.loaded, compiled_operations._load)
teach_for_placed(operations.gather, compiled_operations.gathered, compiled_operations._gather)
