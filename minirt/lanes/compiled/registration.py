"""How numba learns what an operator or a verb is on lanes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin

from minirt.lanes.compiled.types import common, is_number, widen

Result = Callable[..., types.Type | None]  # the type of the result for types of arguments; None: not for these


def register(function: Callable[..., Any], result: Result, patterns: Iterable[tuple[Any, ...]]) -> Callable[..., Any]:
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


def one_number(kind: types.Type) -> types.Type | None:
    """A number of any kind gives one of the same kind."""
    return common(kind) if is_number(kind) else None


def two_numbers(a: types.Type, b: types.Type) -> types.Type | None:
    """Two numbers give lanes if one of them is lanes."""
    return common(a, b) if is_number(a) and is_number(b) else None
