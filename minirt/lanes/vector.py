"""Numbers of the processor's vector registers, as types of numba.

`numba` compiles a function once for each combination of argument types. Here it learns two new types: `f64x8`, eight
float64 in one LLVM vector, and `i1x8`, eight truths. LLVM does arithmetic on vectors as it does on single numbers and
picks the registers that the processor has, so an operator needs no more than the name of one LLVM instruction; a single
number beside a vector is first copied to all of its lanes.

`Vec` becomes a type here too: three numbers, each a float64 or an `f64x8`.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.extending import make_attribute_wrapper, register_model

from minirt.lanes.verbs import WIDTH

CONTRACT = ("contract",)  # a * b + c may round once; nothing else is allowed to change a result


class Lanes(types.Type):
    """`WIDTH` float64."""

    def __init__(self) -> None:
        super().__init__(f"f64x{WIDTH}")


class Mask(types.Type):
    """`WIDTH` truths."""

    def __init__(self) -> None:
        super().__init__(f"i1x{WIDTH}")


class VecType(types.Type):
    """Three numbers of one type."""

    def __init__(self, number: types.Type) -> None:
        self.number = number
        super().__init__(f"Vec({number})")


LANES, MASK = Lanes(), Mask()
F64 = ir.DoubleType()
I32 = ir.IntType(32)
BITS = ir.IntType(WIDTH)
LANES_IR = ir.VectorType(F64, WIDTH)
MASK_IR = ir.VectorType(ir.IntType(1), WIDTH)


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, LANES_IR)


@register_model(Mask)
class MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, MASK_IR)


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
    """The type of a result of numbers of these types."""
    return LANES if LANES in kinds else types.float64


def widen(context: Any, builder: ir.IRBuilder, value: Any, kind: types.Type, target: types.Type) -> Any:
    """`value` as the type `target`: a single number is converted to float64 and copied to all lanes."""
    if kind == target:
        return value
    value = context.cast(builder, value, kind, types.float64)
    return splat(builder, value) if target == LANES else value


def splat(builder: ir.IRBuilder, value: Any) -> Any:
    """A float64 in each lane."""
    one = builder.insert_element(ir.Constant(LANES_IR, ir.Undefined), value, ir.Constant(I32, 0))
    return builder.shuffle_vector(
        one, ir.Constant(LANES_IR, ir.Undefined), ir.Constant(ir.VectorType(I32, WIDTH), [0] * WIDTH)
    )


def llvm(builder: ir.IRBuilder, name: str, *values: Any) -> Any:
    """A call of the LLVM intrinsic `name` on float64 or on lanes."""
    kind = values[0].type
    suffix = f"v{WIDTH}f64" if kind == LANES_IR else "f64"
    function = cgutils.get_or_insert_function(
        builder.module, ir.FunctionType(kind, [value.type for value in values]), f"llvm.{name}.{suffix}"
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
