"""The operators and verbs of the formulas, compiled: what they become on float64, on lanes and on Vecs.

Importing this module teaches numba all of them; nothing in it is called by name. Each entry says for which types of
arguments it holds, which type comes out, and which LLVM instructions do it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin

from minirt.lanes import vec, verbs
from minirt.lanes.vector import (
    BITS,
    CONTRACT,
    LANES,
    LANES_IR,
    MASK,
    Lanes,
    Mask,
    VecType,
    common,
    is_number,
    llvm,
    splat,
    vec_of,
    vec_parts,
    widen,
)

Result = Callable[..., types.Type | None]  # the type of the result for types of arguments; None: not for these
ANY = types.Any


def teach(function: Callable[..., Any], result: Result, patterns: Iterable[tuple[Any, ...]]) -> Callable[..., Any]:
    """Decorator: `function` on arguments that match one of `patterns` is what the decorated generator emits."""

    def generic(self: Any, args: Any, kws: Any) -> Any:
        kind = None if kws else result(*args)
        return None if kind is None else signature(kind, *args)

    def register(generate: Callable[..., Any]) -> Callable[..., Any]:
        infer_global(function)(
            type(f"Lanes_{function.__name__}", (AbstractTemplate,), {"key": function, "generic": generic})
        )
        for pattern in patterns:
            lower_builtin(function, *pattern)(generate)
        return generate

    return register


def same_numbers(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> list[Any]:
    """The arguments, all as single numbers or all as lanes."""
    target = common(*sig.args)
    return [widen(context, builder, value, kind, target) for value, kind in zip(args, sig.args, strict=True)]


# Operators of lanes

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


def teach_logic(function: Callable[..., Any], instruction: str) -> None:
    @teach(function, lambda a, b: MASK if (a, b) == (MASK, MASK) else None, [(Mask, Mask)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return getattr(builder, instruction)(*args)


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


# Verbs


def one_number(kind: types.Type) -> types.Type | None:
    return common(kind) if is_number(kind) else None


def two_numbers(a: types.Type, b: types.Type) -> types.Type | None:
    return common(a, b) if is_number(a) and is_number(b) else None


def teach_llvm(function: Callable[..., Any], name: str, arguments: int) -> None:
    @teach(function, one_number if arguments == 1 else two_numbers, [(ANY,) * arguments])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return llvm(builder, name, *same_numbers(context, builder, sig, args))


def teach_choice(function: Callable[..., Any], symbol: str) -> None:
    @teach(function, two_numbers, [(ANY, ANY)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        a, b = same_numbers(context, builder, sig, args)
        return builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


teach_llvm(verbs.sqrt, "sqrt", 1)
teach_llvm(verbs.fabs, "fabs", 1)
teach_llvm(verbs.floor, "floor", 1)
teach_llvm(verbs.copysign, "copysign", 2)
teach_choice(verbs.minimum, "<")
teach_choice(verbs.maximum, ">")


def chosen(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """The type of `where`: lanes as soon as one of its arguments has lanes."""
    if isinstance(a, VecType) and isinstance(b, VecType):
        return VecType(chosen(mask, a.number, b.number))
    if mask in (MASK, types.boolean) and is_number(a) and is_number(b):
        return LANES if mask == MASK else common(a, b)
    return None


@teach(verbs.where, chosen, [(ANY, ANY, ANY)])
def _where(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    mask, a, b = args
    if isinstance(sig.return_type, VecType):
        number = sig.return_type.number
        parts = [
            builder.select(
                mask,
                *(
                    widen(context, builder, part, kind.number, number)
                    for part, kind in zip(pair, sig.args[1:], strict=True)
                ),
            )
            for pair in zip(vec_parts(builder, a), vec_parts(builder, b), strict=True)
        ]
        return vec_of(context, builder, sig.return_type, parts)
    return builder.select(
        mask,
        *(
            widen(context, builder, value, kind, sig.return_type)
            for value, kind in zip((a, b), sig.args[1:], strict=True)
        ),
    )


def bits(builder: ir.IRBuilder, mask: Any) -> Any:
    """A mask as a whole number with one bit a lane."""
    return builder.bitcast(mask, BITS)


@teach(verbs.any, lambda mask: types.boolean if mask in (MASK, types.boolean) else None, [(ANY,)])
def _any(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.icmp_unsigned("!=", bits(builder, args[0]), ir.Constant(BITS, 0)) if sig.args[0] == MASK else args[0]


@teach(verbs.first, lambda mask: types.int64 if mask == MASK else None, [(Mask,)])
def _first(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(builder.zext(bits(builder, args[0]), ir.IntType(64)), ir.Constant(ir.IntType(1), 1))


@teach(
    verbs.lane,
    lambda x, ray: types.float64 if x == LANES and isinstance(ray, types.Integer) else None,
    [(Lanes, types.Integer)],
)
def _lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))


@teach(verbs.splat, lambda x: LANES if is_number(x) and x != LANES else None, [(ANY,)])
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return splat(builder, context.cast(builder, args[0], sig.args[0], types.float64))


@teach(
    verbs.load, lambda values, start: LANES if isinstance(values, types.Array) else None, [(types.Array, types.Integer)]
)
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = context.make_array(sig.args[0])(context, builder, value=args[0])
    place = builder.gep(values.data, [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.load(builder.bitcast(place, LANES_IR.as_pointer()), align=8)


# Vec


def three_numbers(x: types.Type, y: types.Type, z: types.Type) -> types.Type | None:
    return VecType(common(x, y, z)) if all(map(is_number, (x, y, z))) else None


@teach(vec.Vec, three_numbers, [(ANY, ANY, ANY)])
def _vec(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return vec_of(context, builder, sig.return_type, same_numbers(context, builder, sig, args))


def components(context: Any, builder: ir.IRBuilder, sig: Any, args: Any, number: types.Type) -> list[list[Any]]:
    """For each argument its three components as `number`; a single number counts as three equal ones."""
    table = []
    for value, kind in zip(args, sig.args, strict=True):
        if isinstance(kind, VecType):
            table.append([widen(context, builder, part, kind.number, number) for part in vec_parts(builder, value)])
        else:
            table.append([widen(context, builder, value, kind, number)] * 3)
    return table


def two_vecs(a: types.Type, b: types.Type) -> types.Type | None:
    return VecType(common(a.number, b.number)) if isinstance(a, VecType) and isinstance(b, VecType) else None


def vec_and_number(a: types.Type, b: types.Type) -> types.Type | None:
    if isinstance(a, VecType) and is_number(b):
        return VecType(common(a.number, b))
    return None


def number_and_vec(a: types.Type, b: types.Type) -> types.Type | None:
    return vec_and_number(b, a)


def teach_by_component(
    function: Callable[..., Any], instruction: str, result: Result, pattern: tuple[Any, ...]
) -> None:
    @teach(function, result, [pattern])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        table = components(context, builder, sig, args, sig.return_type.number)
        parts = [getattr(builder, instruction)(*column, flags=CONTRACT) for column in zip(*table, strict=True)]
        return vec_of(context, builder, sig.return_type, parts)


teach_by_component(operator.add, "fadd", two_vecs, (VecType, VecType))
teach_by_component(operator.sub, "fsub", two_vecs, (VecType, VecType))
teach_by_component(operator.mul, "fmul", vec_and_number, (VecType, ANY))
teach_by_component(operator.mul, "fmul", number_and_vec, (ANY, VecType))
teach_by_component(operator.truediv, "fdiv", vec_and_number, (VecType, ANY))


@teach(operator.neg, lambda a: a if isinstance(a, VecType) else None, [(VecType,)])
def _negate_vec(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return vec_of(context, builder, sig.return_type, [builder.fneg(part) for part in vec_parts(builder, args[0])])


@teach(vec.dot, lambda a, b: getattr(two_vecs(a, b), "number", None), [(VecType, VecType)])
def _dot(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = components(context, builder, sig, args, sig.return_type)
    x, y, z = (builder.fmul(*pair, flags=CONTRACT) for pair in zip(a, b, strict=True))
    return builder.fadd(builder.fadd(x, y, flags=CONTRACT), z, flags=CONTRACT)
