"""SIMD operations, compiled, on single numbers, lanes and Vecs: one LLVM instruction or a few."""

from __future__ import annotations

import operator
from collections.abc import Callable
from functools import cache, partial
from typing import Any

from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba import types
from numba.core import cgutils, config

from minirt import lanes
from minirt.lanes.compiled.operators import add, multiply
from minirt.lanes.compiled.types import (
    I32,
    Lanes,
    Mask,
    VecType,
    constant,
    elementwise_type,
    is_number,
    llvm,
    number_type,
    on_each,
    register,
    register_elementwise,
    single,
    vec_of,
    vec_parts,
    widen,
)

# Of a number: the type of its bits, the bits of its fraction, and what is added to its exponent before it is stored.
LAYOUTS = {ir.DoubleType(): (ir.IntType(64), 52, 1023), ir.FloatType(): (ir.IntType(32), 23, 127)}
# 1 / sqrt(x). Normalising a vector takes a square root and a division, and both wait for the one divider of a processor
# core. AVX-512 also has an instruction that estimates 1 / sqrt(x) to 14 bits (rsqrt14). With e = 1 - x y^2 for the
# estimate y, the result is y / sqrt(1 - e): its binomial series y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...) is summed until
# the error is within 2 units in the last place.
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


def inverse_root(builder: ir.IRBuilder, x: Any) -> Any:
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
    """Return 1 / sqrt(x) with a relative error below 2^-14, for lanes of whole registers of AVX-512, one by one."""
    number = x.type.element
    double = number == ir.DoubleType()
    lanes = 8 if double else 16
    register, bits = ir.VectorType(number, lanes), ir.IntType(lanes)
    function = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(register, [register, register, bits]),
        f"llvm.x86.avx512.rsqrt14.{'pd' if double else 'ps'}.512",
    )
    parts = [shuffle(builder, x, x, range(start, start + lanes)) for start in range(0, x.type.count, lanes)]
    results = [builder.call(function, [part, part, ir.Constant(bits, -1)]) for part in parts]
    while len(results) > 1:
        pairs = zip(results[::2], results[1::2], strict=True)
        results = [shuffle(builder, a, b, range(2 * a.type.count)) for a, b in pairs]
    return results[0]


def shuffle(builder: ir.IRBuilder, a: Any, b: Any, lanes: range) -> Any:
    """Return some lanes of a, followed by b."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(I32, len(lanes)), list(lanes)))


def select_if(symbol: str, builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a if it compares so with b, and b if not."""
    return builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


def exponent(builder: ir.IRBuilder, x: Any) -> Any:
    """Return the greatest whole number e with 2^e <= x."""
    integers, fraction, bias = layout(x)
    stored = builder.bitcast(x, integers)
    stored = builder.lshr(stored, constant(stored, fraction))
    return builder.sitofp(builder.sub(stored, constant(stored, bias)), x.type)


def two_to(builder: ir.IRBuilder, x: Any) -> Any:
    """Return 2^x for a whole number x."""
    integers, fraction, bias = layout(x)
    whole = builder.fptosi(llvm(builder, "maxnum", x, constant(x, float(-bias))), integers)
    stored = builder.shl(builder.add(whole, constant(whole, bias)), constant(whole, fraction))
    return builder.bitcast(stored, x.type)


def layout(x: Any) -> tuple[ir.Type, int, int]:
    """Return the type of the bits of numbers, and their count of fraction bits and bias."""
    is_vector = isinstance(x.type, ir.VectorType)
    integer, fraction, bias = LAYOUTS[x.type.element if is_vector else x.type]
    return (ir.VectorType(integer, x.type.count) if is_vector else integer), fraction, bias


def rounded_product(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return a b. Without the fence the flags of the kernel allow fusing the product with a sum that follows."""
    return llvm(builder, "arithmetic.fence", builder.fmul(a, b))


def product_error(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return the rounding error of a b."""
    return llvm(builder, "fma", a, b, builder.fneg(builder.fmul(a, b)))


def intrinsic(name: str) -> Callable[..., Any]:
    """Return what emits an LLVM intrinsic."""
    return lambda builder, *numbers: llvm(builder, name, *numbers)


for _operation, _emit in (
    (lanes.sqrt, intrinsic("sqrt")),
    (lanes.fabs, intrinsic("fabs")),
    (lanes.floor, intrinsic("floor")),
    (lanes.copysign, intrinsic("copysign")),
    (lanes.minimum, partial(select_if, "<")),
    (lanes.maximum, partial(select_if, ">")),
    (lanes.inverse_root, inverse_root),
    (lanes.exponent, exponent),
    (lanes.two_to, two_to),
    (lanes.rounded_product, rounded_product),
    (lanes.product_error, product_error),
):
    register_elementwise(_operation, _emit, result=number_type)


def where_type(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of `where`: lanes if one of its arguments has lanes; of two NamedTuples alike, theirs."""
    if isinstance(a, types.BaseNamedTuple):
        return a if a == b else None
    return elementwise_type(a, b, *([mask.lanes] if isinstance(mask, Mask) else []))


@register(lanes.where, where_type)
def _where(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    select, kind = partial(builder.select, args[0]), sig.return_type
    if not isinstance(kind, types.BaseNamedTuple):
        return on_each(context, builder, kind, sig.args[1:], args[1:], select)
    columns = zip(kind, *(cgutils.unpack_tuple(builder, each) for each in args[1:]), strict=True)
    parts = [on_each(context, builder, each, (each, each), (a, b), select) for each, a, b in columns]
    return context.make_tuple(builder, kind, parts)


def splat_type(x: types.Type, like: types.Type) -> types.Type | None:
    """Return the type of `splat`: that of its second argument, or a Vec of it."""
    if not isinstance(like, (Lanes, types.Float)):
        return None
    return VecType(like) if isinstance(x, VecType) else like if is_number(x) else None


@register(lanes.splat, splat_type)
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return on_each(context, builder, sig.return_type, sig.args[:1], args[:1], lambda x: x)


@register(lanes.lane, lambda x, ray: x.number if isinstance(x, Lanes) and isinstance(ray, types.Integer) else None)
def _lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))


@register(lanes.unit_roundoff, single)
def _unit_roundoff(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(sig.return_type, 2.0 ** {64: -53, 32: -24}[sig.return_type.bitwidth])


@register(lanes.in_single, lambda x: Lanes(types.float32, x.count) if isinstance(x, Lanes) else None)
def _in_single(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return args[0] if sig.args[0] == sig.return_type else builder.fptrunc(args[0], sig.return_type.llvm)


# Vecs.


def vec_type(*kinds: types.Type) -> types.Type | None:
    """Return the type of a Vec of three numbers."""
    number = number_type(*kinds)
    return number and VecType(number)


@register(lanes.Vec, vec_type)
def _vec(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    number = sig.return_type.number
    parts = [widen(context, builder, *each, number) for each in zip(args, sig.args, strict=True)]
    return vec_of(context, builder, sig.return_type, parts)


def quotient_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of a Vec divided by a number."""
    return elementwise_type(a, b) if isinstance(a, VecType) and is_number(b) else None


@register(operator.truediv, quotient_type, [(VecType, types.Any)])
def _divide(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    divisor = widen(context, builder, args[1], sig.args[1], sig.return_type.number)
    inverse = builder.fdiv(constant(divisor, 1.0), divisor)
    return on_each(context, builder, sig.return_type, sig.args[:1], args[:1], lambda part: builder.fmul(part, inverse))


def scalar_product(builder: ir.IRBuilder, a: list[Any], b: list[Any]) -> Any:
    """Return the sum of the products of three components."""
    x, y, z = (multiply(builder, *pair) for pair in zip(a, b, strict=True))
    return add(builder, z, add(builder, x, y))


def dot_type(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of the scalar product of two Vecs."""
    return number_type(a.number, b.number) if isinstance(a, VecType) and isinstance(b, VecType) else None


@register(lanes.dot, dot_type)
def _dot(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = (
        [widen(context, builder, part, kind.number, sig.return_type) for part in vec_parts(builder, value)]
        for value, kind in zip(args, sig.args, strict=True)
    )
    return scalar_product(builder, a, b)


@register(lanes.unit, lambda a: a if isinstance(a, VecType) else None)
def _unit(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    parts = vec_parts(builder, args[0])
    factor = inverse_root(builder, scalar_product(builder, parts, parts))
    return vec_of(context, builder, sig.return_type, [builder.fmul(part, factor) for part in parts])
