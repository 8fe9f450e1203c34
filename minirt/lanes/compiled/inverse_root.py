"""The inverse square root, compiled: an estimate of the processor and a step that makes it precise.

Normalising takes a square root and a division, which have to wait for the one divider of a processor core. AVX-512 can
also estimate 1 / sqrt(x) to 14 bits; with e = 1 - x y^2 for an estimate y, the result is y / sqrt(1 - e), of which
y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...) is computed as far as it counts: to within 2 units in the last place.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils

from minirt.lanes.compiled.types import constant, llvm

SERIES = {"double": (5 / 16, 3 / 8, 1 / 2), "float": (3 / 8, 1 / 2)}  # of e, the highest power first


def has_estimate(context: Any) -> bool:
    """Whether the processor that is compiled for has AVX-512."""
    *_, features = context.codegen().magic_tuple()
    return "+avx512f" in features.split(",")


def inverse_root(context: Any, builder: ir.IRBuilder, x: Any) -> Any:
    """1 / sqrt(x) for positive normal numbers x."""
    if not isinstance(x.type, ir.VectorType) or not has_estimate(context):
        return builder.fdiv(constant(x, 1.0), llvm(builder, "sqrt", x))
    y = estimate(builder, x)
    error = llvm(builder, "fma", builder.fneg(x), builder.fmul(y, y), constant(x, 1.0))
    first, *rest = SERIES[str(x.type.element)]
    total = constant(x, first)
    for coefficient in rest:
        total = llvm(builder, "fma", total, error, constant(x, coefficient))
    return llvm(builder, "fma", builder.fmul(y, error), total, y)


def estimate(builder: ir.IRBuilder, x: Any) -> Any:
    """1 / sqrt(x) with an error below 2^-14, one register after the other."""
    number = x.type.element
    double = number == ir.DoubleType()
    lanes = 8 if double else 16
    register, bits = ir.VectorType(number, lanes), ir.IntType(lanes)
    function = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(register, [register, register, bits]),
        f"llvm.x86.avx512.rsqrt14.{'pd' if double else 'ps'}.512",
    )
    parts = [pick(builder, x, range(start, start + lanes)) for start in range(0, x.type.count, lanes)]
    results = [builder.call(function, [part, part, ir.Constant(bits, -1)]) for part in parts]
    while len(results) > 1:
        results = [join(builder, *pair) for pair in zip(results[::2], results[1::2], strict=True)]
    return results[0]


def pick(builder: ir.IRBuilder, x: Any, lanes: range) -> Any:
    """Some lanes of a vector."""
    return builder.shuffle_vector(x, x, places(lanes))


def join(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """The lanes of a and then those of b."""
    return builder.shuffle_vector(a, b, places(range(2 * a.type.count)))


def places(lanes: range) -> ir.Constant:
    return ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), list(lanes))
