"""Where the compiler learns to pass a scene by its address.

numba passes a tuple as all the numbers in it, and an array is seven of them or more: a scene took a hundred and more
in each call, and taking it apart and putting it together was most of what there was to compile.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import lower_builtin, lower_getattr_generic, register_model

from minirt.kernel import trace, traced
from minirt.lanes.teaching import teach

ADDRESS = ir.IntType(8).as_pointer()


class Placed(types.Type):
    """A tuple that lies in memory. What lies in it and is a tuple is Placed, too, when it is asked for."""

    def __init__(self, content: types.BaseTuple) -> None:
        self.content = content
        super().__init__(f"Placed{content._code}")  # short: it becomes a part of the names of functions


@register_model(Placed)
class PlacedModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Placed) -> None:
        super().__init__(manager, kind, ADDRESS)


@teach(traced.placed, Placed, [(types.BaseTuple,)])
def _placed(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.bitcast(cgutils.alloca_once_value(builder, args[0]), ADDRESS)


@teach(len, lambda table: types.intp if isinstance(table, Placed) else None, [(Placed,)])
def _len(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(types.intp, len(sig.args[0].content))


def kind_at(kind: Placed, place: int) -> types.Type:
    """What is found at a place of a tuple."""
    found = kind.content[place]
    return Placed(found) if isinstance(found, types.BaseTuple) else found


def value_at(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, place: int) -> Any:
    """The same in LLVM's code."""
    whole, part = context.get_value_type(kind.content), kind_at(kind, place)
    address = cgutils.gep_inbounds(builder, builder.bitcast(value, whole.as_pointer()), 0, place)
    return builder.bitcast(address, ADDRESS) if isinstance(part, Placed) else builder.load(address)


@infer_getattr
class PlacedFields(AttributeTemplate):
    """The types of the fields of a NamedTuple."""

    key = Placed

    def generic_resolve(self, kind: Placed, name: str) -> types.Type:
        return kind_at(kind, kind.content.fields.index(name))


@lower_getattr_generic(Placed)  # type: ignore[untyped-decorator]
def _field(context: Any, builder: ir.IRBuilder, kind: Placed, value: Any, name: str) -> Any:
    return value_at(context, builder, kind, value, kind.content.fields.index(name))


@infer_global(trace.over_kinds)
class OverKinds(AbstractTemplate):
    """The type of `over_kinds`: that of the state after the last step."""

    key = trace.over_kinds

    def generic(self, args: Any, kws: Any) -> Any:
        return signature(steps_of(self.context, *args)[-1].return_type, *args)


def steps_of(context: Any, step: Any, groups: Placed, state: Any, given: Any) -> list[Any]:
    """The signature of the step for each kind."""
    found = []
    for place in range(len(groups.content)):
        found.append(context.resolve_function_type(step, (kind_at(groups, place), state, given), {}))
        state = found[-1].return_type
    return found


@lower_builtin(trace.over_kinds, types.Any, Placed, types.Any, types.Any)  # type: ignore[untyped-decorator]
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
