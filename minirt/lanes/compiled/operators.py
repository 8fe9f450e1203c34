"""Python's operators on lanes, masks and Vecs, compiled.

a * b + c may round once: LLVM chooses which products to fuse with a sum. Where both operands are products, its choice
depends on the code around, and the same formula would give other last bits in another kernel: there the first one is
fused. `fmuladd` is one instruction on processors that have it (FMA), and two on others.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt import lanes
from minirt.lanes.compiled.operations import inverse_root
from minirt.lanes.compiled.types import (
    ANY,
    Lanes,
    Mask,
    Result,
    VecType,
    common,
    constant,
    is_number,
    llvm,
    register,
    same_numbers,
    splat,
    two_numbers,
    vec_of,
    vec_parts,
    widen,
)

PAIRS = ((Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes))
CONTRACT = ("contract",)  # a * b + c may round once; nothing else may change a result


def add(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a + b; of two products the first one is not rounded."""
    if is_product(a) and is_product(b):
        return llvm(builder, "fmuladd", *a.operands, b)
    return builder.fadd(a, b, flags=CONTRACT)


def subtract(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a - b; of two products the first one is not rounded."""
    if is_product(a) and is_product(b):
        return llvm(builder, "fmuladd", *a.operands, builder.fneg(b))
    return builder.fsub(a, b, flags=CONTRACT)


def multiply(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a b."""
    return builder.fmul(a, b, flags=CONTRACT)


def divide(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a / b."""
    return builder.fdiv(a, b, flags=CONTRACT)


def is_product(value: Any) -> bool:
    """Whether a value is emitted as a product."""
    return isinstance(value, ir.Instruction) and value.opname == "fmul"


def lanes_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of arithmetic on two numbers of which at least one is lanes."""
    kind = two_numbers(a, b)
    return kind if isinstance(kind, Lanes) else None


def mask_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of a comparison of two numbers of which at least one is lanes."""
    kind = lanes_type(a, b)
    return kind and Mask(kind)


def register_arithmetic(function: Callable[..., Any], emit: Callable[..., Any]) -> None:
    """Register an arithmetic operator, which `emit` emits."""

    @register(function, lanes_type, PAIRS)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return emit(builder, *same_numbers(context, builder, sig, args))


def register_comparison(function: Callable[..., Any], symbol: str) -> None:
    """Register a comparison; with NaN all are false but `!=`."""

    @register(function, mask_type, PAIRS)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        compare = builder.fcmp_unordered if symbol == "!=" else builder.fcmp_ordered
        return compare(symbol, *same_numbers(context, builder, sig, args))


def logic_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of logic on two masks, or on a mask and one truth value for all lanes."""
    mask = next((kind for kind in (a, b) if isinstance(kind, Mask)), None)
    return mask if {a, b} <= {mask, types.boolean} else None


def register_logic(function: Callable[..., Any], instruction: str) -> None:
    """Register a logical operator as one LLVM instruction."""

    @register(function, logic_type, [(Mask, Mask), (Mask, types.Boolean), (types.Boolean, Mask)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        masks = (
            value if isinstance(kind, Mask) else splat(builder, value, sig.return_type.lanes.count)
            for value, kind in zip(args, sig.args, strict=True)
        )
        return getattr(builder, instruction)(*masks)


for _function, _emit in (
    (operator.add, add),
    (operator.sub, subtract),
    (operator.mul, multiply),
    (operator.truediv, divide),
):
    register_arithmetic(_function, _emit)
for _function, _symbol in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
    (operator.ne, "!="),
):
    register_comparison(_function, _symbol)
for _function, _instruction in ((operator.and_, "and_"), (operator.or_, "or_"), (operator.xor, "xor")):
    register_logic(_function, _instruction)


@register(operator.neg, lambda a: a if isinstance(a, Lanes) else None, [(Lanes,)])
def _negate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.fneg(args[0])


@register(operator.invert, lambda a: a if isinstance(a, Mask) else None, [(Mask,)])
def _invert(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.not_(args[0])


def vec_type(x: types.Type, y: types.Type, z: types.Type) -> types.Type | None:
    """Return the type of a Vec of three numbers."""
    return VecType(common(x, y, z)) if all(map(is_number, (x, y, z))) else None


@register(lanes.Vec, vec_type, [(ANY, ANY, ANY)])
def _vec(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return vec_of(context, builder, sig.return_type, same_numbers(context, builder, sig, args))


def components(context: Any, builder: ir.IRBuilder, sig: Any, args: Any, number: types.Type) -> list[list[Any]]:
    """Return the three components of each argument, converted to `number`; a single number is repeated."""
    table = []
    for value, kind in zip(args, sig.args, strict=True):
        if isinstance(kind, VecType):
            table.append([widen(context, builder, part, kind.number, number) for part in vec_parts(builder, value)])
        else:
            table.append([widen(context, builder, value, kind, number)] * 3)
    return table


def two_vecs(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of an operation on two Vecs."""
    return VecType(common(a.number, b.number)) if isinstance(a, VecType) and isinstance(b, VecType) else None


def vec_and_number(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of an operation on a Vec and a number."""
    if isinstance(a, VecType) and is_number(b):
        return VecType(common(a.number, b))
    return None


def number_and_vec(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of an operation on a number and a Vec."""
    return vec_and_number(b, a)


def register_by_component(
    function: Callable[..., Any], emit: Callable[..., Any], result: Result, pattern: tuple[Any, ...]
) -> None:
    """Register an operator, which `emit` emits for each component."""

    @register(function, result, [pattern])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        table = components(context, builder, sig, args, sig.return_type.number)
        parts = [emit(builder, *column) for column in zip(*table, strict=True)]
        return vec_of(context, builder, sig.return_type, parts)


register_by_component(operator.add, add, two_vecs, (VecType, VecType))
register_by_component(operator.sub, subtract, two_vecs, (VecType, VecType))
register_by_component(operator.mul, multiply, vec_and_number, (VecType, ANY))
register_by_component(operator.mul, multiply, number_and_vec, (ANY, VecType))


@register(operator.truediv, vec_and_number, [(VecType, ANY)])
def _divide(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    number = sig.return_type.number
    parts, (divisor, *_) = components(context, builder, sig, args, number)
    inverse = builder.fdiv(constant(divisor, 1.0), divisor)
    return vec_of(context, builder, sig.return_type, [builder.fmul(part, inverse) for part in parts])


@register(operator.neg, lambda a: a if isinstance(a, VecType) else None, [(VecType,)])
def _negate_vec(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return vec_of(context, builder, sig.return_type, [builder.fneg(part) for part in vec_parts(builder, args[0])])


def scalar_product(builder: ir.IRBuilder, a: list[Any], b: list[Any]) -> Any:
    """Return the sum of the products of three components."""
    x, y, z = (multiply(builder, *pair) for pair in zip(a, b, strict=True))
    return add(builder, z, add(builder, x, y))


@register(lanes.dot, lambda a, b: getattr(two_vecs(a, b), "number", None), [(VecType, VecType)])
def _dot(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return scalar_product(builder, *components(context, builder, sig, args, sig.return_type))


@register(lanes.unit, lambda a: a if isinstance(a, VecType) else None, [(VecType,)])
def _unit(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    parts = vec_parts(builder, args[0])
    factor = inverse_root(context, builder, scalar_product(builder, parts, parts))
    return vec_of(context, builder, sig.return_type, [builder.fmul(part, factor) for part in parts])
