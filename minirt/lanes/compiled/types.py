"""SIMD lanes, masks and Vecs as types of numba, and the registration of operations on them.

`f64x16` and `f32x32` are sixteen or thirty-two floating-point numbers in one LLVM vector, `i1x16` and `i1x32` as many
truth values. LLVM does arithmetic on vectors as on single numbers and spreads a vector over as many registers as it
takes (two of AVX-512, four of AVX2, eight of NEON): an operator is the name of one LLVM instruction. A single number
beside a vector is first copied to all of its lanes. A Vec is three numbers, each a single one or lanes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, make_attribute_wrapper, register_model

from minirt.lanes import BYTES


class Lanes(types.Type):
    """A number for each ray of a packet, all float64 or all float32; or half of the latter."""

    def __init__(self, number: types.Type, count: int | None = None) -> None:
        self.number = number
        self.count = count or 8 * BYTES // number.bitwidth
        self.llvm = ir.VectorType({32: ir.FloatType(), 64: ir.DoubleType()}[number.bitwidth], self.count)
        super().__init__(f"f{number.bitwidth}x{self.count}")


class Mask(types.Type):
    """A truth value for each lane."""

    def __init__(self, lanes: Lanes) -> None:
        self.lanes = Lanes(types.float64) if lanes.count == BYTES // 8 else lanes
        self.llvm = ir.VectorType(ir.IntType(1), lanes.count)
        super().__init__(f"i1x{lanes.count}")


class VecType(types.Type):
    """Three numbers of one type: x, y and z."""

    def __init__(self, number: types.Type) -> None:
        self.number = number
        super().__init__(f"Vec({number})")


ANYTHING = ((types.VarArg(types.Any),),)  # the pattern of arguments of any types
Result = Callable[..., types.Type | None]  # result type for argument types; None: the operation does not take them
REGISTERED: set[Any] = set()  # functions with a compiled form of their own
I32 = ir.IntType(32)


@register_model(Lanes)
@register_model(Mask)
class ValueModel(models.PrimitiveModel):
    """Values of a type are those of its own LLVM type."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, kind.llvm)


@register_model(VecType)
class VecModel(models.StructModel):
    """A Vec is an LLVM structure of three numbers."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [(axis, kind.number) for axis in "xyz"])


for axis in "xyz":
    make_attribute_wrapper(VecType, axis, axis)


def is_number(kind: Any) -> bool:
    """Whether a type is a single number or lanes."""
    return isinstance(kind, (Lanes, types.Float, types.Integer))


def common(*kinds: types.Type) -> types.Type:
    """Return the type that numbers of these types are converted to: lanes if one of them is lanes."""
    lanes = [kind for kind in kinds if isinstance(kind, Lanes)]
    if lanes:
        return lanes[0]
    floats = {kind for kind in kinds if isinstance(kind, types.Float)}
    return types.float32 if floats == {types.float32} else types.float64


def widen(context: Any, builder: ir.IRBuilder, value: Any, kind: types.Type, target: types.Type) -> Any:
    """Convert a value to the type `target`: a single number is rounded to its precision and copied to all lanes."""
    if kind == target:
        return value
    if not isinstance(target, Lanes):
        return context.cast(builder, value, kind, target)
    return splat(builder, context.cast(builder, value, kind, target.number), target.count)


def splat(builder: ir.IRBuilder, value: Any, count: int) -> Any:
    """Copy a value to each of `count` lanes."""
    undefined = ir.Constant(ir.VectorType(value.type, count), ir.Undefined)
    first = builder.insert_element(undefined, value, ir.Constant(I32, 0))
    return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(I32, count), [0] * count))


def constant(like: Any, value: float | int) -> ir.Constant:
    """Return a constant of the LLVM type of `like`, the same in each lane."""
    return ir.Constant(like.type, [value] * like.type.count if isinstance(like.type, ir.VectorType) else value)


def llvm(builder: ir.IRBuilder, name: str, *values: Any, result: Any = None, flags: tuple[str, ...] = ()) -> Any:
    """Call the LLVM intrinsic `name` on single numbers or on lanes; its result is of their type, or of another one."""
    kind = values[0].type
    is_vector = isinstance(kind, ir.VectorType)
    number = "f64" if (kind.element if is_vector else kind) == ir.DoubleType() else "f32"
    function = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(result or kind, [value.type for value in values]),
        f"llvm.{name}.v{kind.count}{number}" if is_vector else f"llvm.{name}.{number}",
    )
    return builder.call(function, values, fastmath=flags)


def vec_parts(builder: ir.IRBuilder, value: Any) -> list[Any]:
    """Return the three components of a Vec."""
    if isinstance(value, ir.instructions.InsertValue):  # by `vec_of`: a part is seen as what it is, such as a product
        return [value.aggregate.aggregate.value, value.aggregate.value, value.value]
    return [builder.extract_value(value, index) for index in range(3)]


def vec_of(context: Any, builder: ir.IRBuilder, kind: VecType, parts: list[Any]) -> Any:
    """Return the Vec of three components."""
    vec = ir.Constant(context.get_value_type(kind), ir.Undefined)
    for index, part in enumerate(parts):
        vec = builder.insert_value(vec, part, index)
    return vec


def register(
    function: Callable[..., Any], result: Result, patterns: Iterable[tuple[Any, ...]] = ANYTHING
) -> Callable[..., Any]:
    """Return a decorator of a function that emits the code of `function`, and enter `function` into `REGISTERED`.

    The code is for arguments whose types match one of `patterns`. What is decorated is `generate(context, builder,
    signature, values)`, as numba's `lower_builtin` takes it. `result` is called with the types of the arguments and
    returns that of the result, or None where the operation does not take them.
    """

    def generic(self: Any, args: Any, kws: Any) -> Any:
        kind = None if kws else result(*args)
        return None if kind is None else signature(kind, *args)

    def decorate(generate: Callable[..., Any]) -> Callable[..., Any]:
        REGISTERED.add(function)
        infer_global(function)(
            type(f"Lanes_{function.__name__}", (AbstractTemplate,), {"key": function, "generic": generic})
        )
        for pattern in patterns:
            lower_builtin(function, *pattern)(generate)
        return generate

    return decorate


def number_type(*kinds: types.Type) -> types.Type | None:
    """Return the type of an operation on numbers: lanes if one of them is lanes."""
    return common(*kinds) if all(map(is_number, kinds)) else None


def single(x: types.Type) -> types.Type | None:
    """Return the type of one lane of x, or of x itself where that is a single number."""
    return getattr(common(x), "number", common(x)) if is_number(x) else None


def elementwise_type(*kinds: types.Type) -> types.Type | None:
    """Return the type of an operation on numbers and Vecs: a Vec if one of them is a Vec."""
    number = number_type(*(kind.number if isinstance(kind, VecType) else kind for kind in kinds))
    return VecType(number) if number and any(isinstance(kind, VecType) for kind in kinds) else number


def on_each(context: Any, builder: ir.IRBuilder, kind: types.Type, kinds: Any, values: Any, emit: Any) -> Any:
    """Return the number or the Vec, of the type `kind`, whose components `emit` computes from those of some values.

    `kinds` are the types of the `values`. `emit` gets one LLVM value of each, converted to the type of the result: once
    for a number, three times for a Vec. A number beside a Vec counts for each component.
    """
    is_vec = isinstance(kind, VecType)
    number = kind.number if is_vec else kind
    table = []
    for value, each in zip(values, kinds, strict=True):
        if isinstance(each, VecType):
            table.append([widen(context, builder, part, each.number, number) for part in vec_parts(builder, value)])
        else:
            table.append([widen(context, builder, value, each, number)] * (3 if is_vec else 1))
    parts = [emit(*column) for column in zip(*table, strict=True)]
    return vec_of(context, builder, kind, parts) if is_vec else parts[0]


def register_elementwise(
    function: Callable[..., Any],
    emit: Callable[..., Any],
    patterns: Iterable[tuple[Any, ...]] = ANYTHING,
    result: Result = elementwise_type,
) -> None:
    """Compile `function`, on numbers and on the components of Vecs, to what `emit(builder, *numbers)` emits."""

    @register(function, result, patterns)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return on_each(context, builder, sig.return_type, sig.args, args, partial(emit, builder))
