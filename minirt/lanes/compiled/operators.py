"""Python's operators on lanes and masks, compiled."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes.compiled import fused
from minirt.lanes.compiled.registration import register, same_numbers, two_numbers
from minirt.lanes.compiled.types import Lanes, Mask, splat

PAIRS = ((Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes))


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
    (operator.add, fused.add),
    (operator.sub, fused.subtract),
    (operator.mul, fused.multiply),
    (operator.truediv, fused.divide),
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
