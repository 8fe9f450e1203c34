"""Registration of plain functions that kernels inline."""

from __future__ import annotations

from collections.abc import Collection
from types import FunctionType, ModuleType

from numba.extending import register_jitable

from minirt.kernel.compiler.options import INLINED


def inline_functions_of(module: ModuleType, besides: Collection[object] = ()) -> None:
    """Let compiled code inline the functions that a module defines, but for those in `besides`."""
    for function in own_functions(module):
        if function not in besides:
            register_jitable(**INLINED)(function)


def own_functions(module: ModuleType) -> list[FunctionType]:
    """Return the functions that a module defines itself."""
    members = vars(module).values()
    return [each for each in members if isinstance(each, FunctionType) and each.__module__ == module.__name__]
