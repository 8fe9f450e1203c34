"""Registration of SIMD operations and operators with numba: types of results, and the LLVM code to emit."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin

from minirt.lanes.compiled.types import common, is_number, widen

Result = Callable[..., types.Type | None]  # result type for argument types; None: the operation does not take them


def register(function: Callable[..., Any], result: Result, patterns: Iterable[tuple[Any, ...]]) -> Callable[..., Any]:
    """Decorator: compile `function`, on arguments that match one of `patterns`, to the code that a generator emits."""

    def generic(self: Any, args: Any, kws: Any) -> Any:
        kind = None if kws else result(*args)
        return None if kind is None else signature(kind, *args)

    def decorate(generate: Callable[..., Any]) -> Callable[..., Any]:
        infer_global(function)(
            type(f"Lanes_{function.__name__}", (AbstractTemplate,), {"key": function, "generic": generic})
        )
        for pattern in patterns:
            lower_builtin(function, *pattern)(generate)
        return generate

    return decorate


def same_numbers(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> list[Any]:
    """Return the arguments, all as single numbers or all as lanes."""
    target = common(*sig.args)
    return [widen(context, builder, value, kind, target) for value, kind in zip(args, sig.args, strict=True)]


def one_number(kind: types.Type) -> types.Type | None:
    """Return the type of an operation on one number: that of the number."""
    return common(kind) if is_number(kind) else None


def two_numbers(a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of an operation on two numbers: lanes if one of them is lanes."""
    return common(a, b) if is_number(a) and is_number(b) else None


def single(x: types.Type) -> types.Type | None:
    """Return the type of one lane of x, or of x itself where that is a single number."""
    return getattr(common(x), "number", common(x)) if is_number(x) else None
