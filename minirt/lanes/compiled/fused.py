"""Sums of products that round once, chosen where the code is emitted.

Left to LLVM, which products are fused with sums depends on the code around: the same formula would give other last bits
in another kernel. `fmuladd` is one instruction on processors that have it (FMA), and two on others.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir

from minirt.lanes.compiled.types import llvm


def add(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a + b; if either is a product, the first one is not rounded."""
    if is_product(a):
        return llvm(builder, "fmuladd", *a.operands, b)
    if is_product(b):
        return llvm(builder, "fmuladd", *b.operands, a)
    return builder.fadd(a, b)


def subtract(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a - b; if either is a product, the first one is not rounded."""
    if is_product(a):
        return llvm(builder, "fmuladd", *a.operands, builder.fneg(b))
    if is_product(b):
        x, y = b.operands
        return llvm(builder, "fmuladd", builder.fneg(x), y, a)
    return builder.fsub(a, b)


def multiply(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a b."""
    return builder.fmul(a, b)


def divide(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a / b."""
    return builder.fdiv(a, b)


def is_product(value: Any) -> bool:
    """Whether a value is emitted as a product."""
    return isinstance(value, ir.Instruction) and value.opname == "fmul"
