"""Arithmetic of which a * b + c may round once.

LLVM chooses which products to fuse with a sum. Where both operands are products, its choice depends on the code around,
and the same formula would give other last bits in another kernel: there the first one is fused. `fmuladd` is one
instruction on processors that have it (FMA), and two on others.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir

from minirt.lanes.compiled.types import llvm

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
