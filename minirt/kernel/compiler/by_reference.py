"""Passing a scene by reference: one address in place of all its arrays.

numba passes a tuple as all the numbers in it, and an array is seven of them or more: a scene took a hundred and more
in each call, and taking it apart and putting it together was most of the code to compile. Reading through a reference
also takes fewer instructions, as indices are not negative and the rows of an array lie one after the other.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import lower_getattr_generic, register_model

from minirt.kernel import scene_arrays
from minirt.lanes.compiled.types import register

ADDRESS = ir.IntType(8).as_pointer()
NUMBERS: dict[types.Type, int] = {}  # of types that are referred to: short, as they become parts of function names
DATA, SHAPE = 4, 5  # positions in numba's array structure: meminfo, parent, nitems, itemsize, data, shape, strides


class Reference(types.Type):
    """The address of a tuple or an array in memory; tuples and arrays in it are reached by reference too."""

    def __init__(self, content: types.BaseTuple | types.Array) -> None:
        self.content = content
        super().__init__(f"Reference{NUMBERS.setdefault(content, len(NUMBERS))}")


@register_model(Reference)
class ReferenceModel(models.PrimitiveModel):
    """A reference is an address."""

    def __init__(self, manager: Any, kind: Reference) -> None:
        super().__init__(manager, kind, ADDRESS)


def can_be_referenced(kind: Any) -> bool:
    """Whether a type is a tuple, or an array whose rows lie one after the other."""
    return isinstance(kind, types.BaseTuple) or (isinstance(kind, types.Array) and kind.layout == "C")


def is_array(kind: Any) -> bool:
    """Whether a type is a reference to an array."""
    return isinstance(kind, Reference) and isinstance(kind.content, types.Array)


def reference_to(kind: Any) -> Reference | None:
    """Return the type of a reference to a tuple or an array; None for other types."""
    return Reference(kind) if can_be_referenced(kind) else None


@register(scene_arrays.by_reference, reference_to, [(types.Any,)])
def _by_reference(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.bitcast(cgutils.alloca_once_value(builder, args[0]), ADDRESS)


def address_of_part(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, position: int) -> Any:
    """Return the address of an item of a tuple, or of a member of numba's array structure."""
    whole = context.get_value_type(kind.content).as_pointer()
    return cgutils.gep_inbounds(builder, builder.bitcast(value, whole), 0, position)


def item_type(kind: Reference, position: int) -> types.Type:
    """Return the type of an item of a tuple."""
    item = kind.content[position]
    return reference_to(item) or item


def item_of(context: Any, builder: ir.IRBuilder, kind: Reference, value: Any, position: int) -> Any:
    """Return an item of a tuple: a number, or a reference."""
    address = address_of_part(context, builder, kind, value, position)
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
        return builder.load(address_of_part(context, builder, kind, value, SHAPE))
    return item_of(context, builder, kind, value, kind.content.fields.index(name))


@register(len, lambda table: types.intp if isinstance(table, Reference) else None, [(Reference,)])
def _len(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(types.intp, len(sig.args[0].content))
