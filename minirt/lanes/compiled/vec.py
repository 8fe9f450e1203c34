"""Vec and its operators, compiled: one instruction for each of the three components."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations, vec
from minirt.lanes.compiled import fused
from minirt.lanes.compiled.inverse_root import inverse_root
from minirt.lanes.compiled.registration import Result, register, same_numbers
from minirt.lanes.compiled.types import VecType, common, constant, is_number, vec_of, vec_parts, widen

ANY = types.Any


def vec_type(x: types.Type, y: types.Type, z: types.Type) -> types.Type | None:
    """Return the type of a Vec of three numbers."""
    return VecType(common(x, y, z)) if all(map(is_number, (x, y, z))) else None


@register(vec.Vec, vec_type, [(ANY, ANY, ANY)])
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


register_by_component(operator.add, fused.add, two_vecs, (VecType, VecType))
register_by_component(operator.sub, fused.subtract, two_vecs, (VecType, VecType))
register_by_component(operator.mul, fused.multiply, vec_and_number, (VecType, ANY))
register_by_component(operator.mul, fused.multiply, number_and_vec, (ANY, VecType))


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
    x, y, z = (fused.multiply(builder, *pair) for pair in zip(a, b, strict=True))
    return fused.add(builder, z, fused.add(builder, x, y))


@register(vec.dot, lambda a, b: getattr(two_vecs(a, b), "number", None), [(VecType, VecType)])
def _dot(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return scalar_product(builder, *components(context, builder, sig, args, sig.return_type))


@register(operations.unit, lambda a: a if isinstance(a, VecType) else None, [(VecType,)])
def _unit(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    parts = vec_parts(builder, args[0])
    factor = inverse_root(context, builder, scalar_product(builder, parts, parts))
    return vec_of(context, builder, sig.return_type, [builder.fmul(part, factor) for part in parts])
