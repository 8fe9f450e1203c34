"""Numbers of the processor's vector registers, as types of numba.

`numba` compiles a function once for each combination of argument types. Here it learns new types: `f64x16` and
`f32x32`, sixteen or thirty-two floating-point numbers in one LLVM vector, and `i1x16` and `i1x32`, as many truths. LLVM
does arithmetic on vectors as it does on single numbers and spreads a vector over as many registers of the processor as
it takes (two of AVX-512, four of AVX2, eight of NEON), so an operator needs no more than the name of one LLVM
instruction; a single number beside a vector is first copied to all of its lanes.

`Vec` becomes a type here too: three numbers, each a single one or lanes.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.extending import make_attribute_wrapper, register_model

from minirt.lanes.operations import BYTES

CONTRACT = ("contract",)  # a * b + c may round once; nothing else is allowed to change a result


class Lanes(types.Type):
    """As many numbers of one type, float64 or float32, as there are rays in a packet of that precision."""

    def __init__(self, number: types.Type) -> None:
        self.number = number
        self.count = 8 * BYTES // number.bitwidth
        super().__init__(f"f{number.bitwidth}x{self.count}")


class Mask(types.Type):
    """A truth for each number of some lanes."""

    def __init__(self, lanes: Lanes) -> None:
        self.lanes = lanes
        super().__init__(f"i1x{lanes.count}")


class VecType(types.Type):
    """Three numbers of one type."""

    def __init__(self, number: types.Type) -> None:
        self.number = number
        super().__init__(f"Vec({number})")


I32 = ir.IntType(32)


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, ir.VectorType(manager.lookup(kind.number).get_value_type(), kind.count))


@register_model(Mask)
class MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), kind.lanes.count))


@register_model(VecType)
class VecModel(models.StructModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [(axis, kind.number) for axis in "xyz"])


for axis in "xyz":
    make_attribute_wrapper(VecType, axis, axis)


def is_number(kind: Any) -> bool:
    """Whether a type stands for one number or for one number a lane."""
    return isinstance(kind, (Lanes, types.Float, types.Integer))


def common(*kinds: types.Type) -> types.Type:
    """The type of a result of numbers of these types: that of the lanes where there are any."""
    lanes = [kind for kind in kinds if isinstance(kind, Lanes)]
    if lanes:
        return lanes[0]
    floats = {kind for kind in kinds if isinstance(kind, types.Float)}
    return types.float32 if floats == {types.float32} else types.float64


def widen(context: Any, builder: ir.IRBuilder, value: Any, kind: types.Type, target: types.Type) -> Any:
    """`value` as the type `target`: a single number is rounded to its precision and copied to all lanes."""
    if kind == target:
        return value
    if not isinstance(target, Lanes):
        return context.cast(builder, value, kind, target)
    return splat(builder, context.cast(builder, value, kind, target.number), target.count)


def splat(builder: ir.IRBuilder, value: Any, count: int) -> Any:
    """A value in each of so many lanes."""
    nothing = ir.Constant(ir.VectorType(value.type, count), ir.Undefined)
    one = builder.insert_element(nothing, value, ir.Constant(I32, 0))
    return builder.shuffle_vector(one, nothing, ir.Constant(ir.VectorType(I32, count), [0] * count))


def constant(like: Any, value: float | int) -> ir.Constant:
    """A number of the LLVM type of `like`, in each lane where that has lanes."""
    return ir.Constant(like.type, [value] * like.type.count if isinstance(like.type, ir.VectorType) else value)


def llvm(builder: ir.IRBuilder, name: str, *values: Any) -> Any:
    """A call of the LLVM intrinsic `name` on numbers or on lanes."""
    kind = values[0].type
    lanes = isinstance(kind, ir.VectorType)
    number = "f64" if (kind.element if lanes else kind) == ir.DoubleType() else "f32"
    function = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(kind, [value.type for value in values]),
        f"llvm.{name}.v{kind.count}{number}" if lanes else f"llvm.{name}.{number}",
    )
    return builder.call(function, values)


def vec_parts(builder: ir.IRBuilder, value: Any) -> list[Any]:
    """The three components of a Vec."""
    return [builder.extract_value(value, index) for index in range(3)]


def vec_of(context: Any, builder: ir.IRBuilder, kind: VecType, parts: list[Any]) -> Any:
    """The Vec of three components."""
    made = cgutils.create_struct_proxy(kind)(context, builder)
    made.x, made.y, made.z = parts
    return made._getvalue()
