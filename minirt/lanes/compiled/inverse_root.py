"""Inverse square root, compiled: the processor's estimate, refined by a series.

Normalising a vector takes a square root and a division, and both wait for the one divider of a processor core. AVX-512
also has an instruction that estimates 1 / sqrt(x) to 14 bits (rsqrt14). With e = 1 - x y^2 for the estimate y, the
result is y / sqrt(1 - e): its binomial series y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...) is summed until the error is
within 2 units in the last place.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba.core import cgutils, config

from minirt.lanes.compiled.types import constant, llvm

SERIES = {"double": (5 / 16, 3 / 8, 1 / 2), "float": (3 / 8, 1 / 2)}  # coefficients of e, the highest power first


@cache
def has_estimate() -> bool:
    """Whether the processor that is compiled for has AVX-512: as NUMBA_CPU_FEATURES says, or the one at hand."""
    if config.CPU_FEATURES is not None:
        return "+avx512f" in config.CPU_FEATURES.split(",")
    try:
        return bool(config.ENABLE_AVX and get_host_cpu_features().get("avx512f"))
    except RuntimeError:  # LLVM does not know the features of this processor
        return False


def inverse_root(context: Any, builder: ir.IRBuilder, x: Any) -> Any:
    """Return 1 / sqrt(x) for positive normal numbers x."""
    if not isinstance(x.type, ir.VectorType) or not has_estimate():
        return builder.fdiv(constant(x, 1.0), llvm(builder, "sqrt", x))
    y = estimate(builder, x)
    error = llvm(builder, "fma", builder.fneg(x), builder.fmul(y, y), constant(x, 1.0))
    first, *rest = SERIES[str(x.type.element)]
    total = constant(x, first)
    for coefficient in rest:
        total = llvm(builder, "fma", total, error, constant(x, coefficient))
    return llvm(builder, "fma", builder.fmul(y, error), total, y)


def estimate(builder: ir.IRBuilder, x: Any) -> Any:
    """Return 1 / sqrt(x) with a relative error below 2^-14, one register after the other."""
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
    """Return some lanes of a vector."""
    return builder.shuffle_vector(x, x, lane_indices(lanes))


def join(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return the lanes of a and after them the lanes of b."""
    return builder.shuffle_vector(a, b, lane_indices(range(2 * a.type.count)))


def lane_indices(lanes: range) -> ir.Constant:
    """Return the indices of lanes as an LLVM vector, for a shuffle."""
    return ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), list(lanes))
