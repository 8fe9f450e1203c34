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

from minirt.lanes.compiled.types import (
    Lanes,
    Mask,
    VecType,
    elementwise_type,
    llvm,
    number_type,
    register,
    register_elementwise,
    splat,
    widen,
)

ANY = types.Any
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


def is_product(value: Any) -> bool:
    """Whether a value is emitted as a product."""
    return isinstance(value, ir.Instruction) and value.opname == "fmul"


def operator_type(*kinds: types.Type) -> types.Type | None:
    """Return the type of an operator on numbers and Vecs of which at least one is lanes or a Vec."""
    return elementwise_type(*kinds) if any(isinstance(kind, (Lanes, VecType)) for kind in kinds) else None


for _operator, _emit, _patterns in (
    (operator.add, add, (*PAIRS, (VecType, VecType))),
    (operator.sub, subtract, (*PAIRS, (VecType, VecType))),
    (operator.mul, multiply, (*PAIRS, (VecType, ANY), (ANY, VecType))),
    (operator.truediv, ir.IRBuilder.fdiv, PAIRS),
    (operator.neg, ir.IRBuilder.fneg, ((Lanes,), (VecType,))),
):
    register_elementwise(_operator, _emit, _patterns, operator_type)


def mask_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of a comparison of two numbers of which at least one is lanes."""
    kind = number_type(a, b)
    return Mask(kind) if isinstance(kind, Lanes) else None


def register_comparison(function: Callable[..., Any], symbol: str) -> None:
    """Register a comparison; with NaN all are false but `!=`."""

    @register(function, mask_type, PAIRS)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        compare = builder.fcmp_unordered if symbol == "!=" else builder.fcmp_ordered
        target = number_type(*sig.args)
        numbers = (widen(context, builder, *each, target) for each in zip(args, sig.args, strict=True))
        return compare(symbol, *numbers)


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


for _name, _symbol in {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "==", "ne": "!="}.items():
    register_comparison(getattr(operator, _name), _symbol)
for _name in ("and_", "or_", "xor"):
    register_logic(getattr(operator, _name), _name)


@register(operator.invert, lambda a: a if isinstance(a, Mask) else None, [(Mask,)])
def _invert(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.not_(args[0])
