"""The operators of Python, compiled, on lanes and masks."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import WIDTH
from minirt.lanes.teaching import Result, same_numbers, teach
from minirt.lanes.vector import CONTRACT, LANES, MASK, MASK_IR, Lanes, Mask, is_number

PAIRS = ((Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes))


def of_lanes(result: types.Type) -> Result:
    """`result` for two numbers of which one is lanes."""
    return lambda *kinds: result if len(kinds) == 2 and LANES in kinds and all(map(is_number, kinds)) else None


def teach_arithmetic(function: Callable[..., Any], instruction: str) -> None:
    @teach(function, of_lanes(LANES), PAIRS)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return getattr(builder, instruction)(*same_numbers(context, builder, sig, args), flags=CONTRACT)


def teach_comparison(function: Callable[..., Any], symbol: str) -> None:
    @teach(function, of_lanes(MASK), PAIRS)
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        compare = builder.fcmp_unordered if symbol == "!=" else builder.fcmp_ordered
        return compare(symbol, *same_numbers(context, builder, sig, args))


def of_masks(a: types.Type, b: types.Type) -> types.Type | None:
    """A mask for two masks, or for a mask and a truth that holds for all rays."""
    return MASK if MASK in (a, b) and {a, b} <= {MASK, types.boolean} else None


def teach_logic(function: Callable[..., Any], instruction: str) -> None:
    @teach(function, of_masks, [(Mask, Mask), (Mask, types.Boolean), (types.Boolean, Mask)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        masks = (
            value if kind == MASK else builder.select(value, *(ir.Constant(MASK_IR, [bit] * WIDTH) for bit in (1, 0)))
            for value, kind in zip(args, sig.args, strict=True)
        )
        return getattr(builder, instruction)(*masks)


for _function, _instruction in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    teach_arithmetic(_function, _instruction)
for _function, _symbol in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
    (operator.ne, "!="),
):
    teach_comparison(_function, _symbol)
for _function, _instruction in ((operator.and_, "and_"), (operator.or_, "or_"), (operator.xor, "xor")):
    teach_logic(_function, _instruction)


@teach(operator.neg, lambda a: LANES if a == LANES else None, [(Lanes,)])
def _negate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.fneg(args[0])


@teach(operator.invert, lambda a: MASK if a == MASK else None, [(Mask,)])
def _invert(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.not_(args[0])
