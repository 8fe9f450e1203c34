"""Compilation of kernels, which are loaded from disk where an earlier run has compiled them."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from numba import njit

from minirt.kernel.compiler import cache_folder, fork_lock  # noqa: F401  (registers itself)
from minirt.kernel.compiler.options import FAILED, FLAGS

CACHE = None if FAILED else cache_folder.folder()  # None: kernels stay in memory


def compiled(function: Callable[..., Any], folder: Path | None, *signatures: Any) -> Any:
    """Return the compiled form of a function, which is kept in a folder, or in memory alone where that is None.

    It is compiled or loaded at once for `signatures`, the types of its arguments; without any, when it is first called.
    """
    dispatcher = njit(no_cfunc_wrapper=True, **FLAGS)(function)
    if folder:
        cache = import_module("minirt.kernel.compiler.code_cache").CodeCache(function, folder)
        internals().set_cache(dispatcher, cache)
    for signature in signatures:
        dispatcher.compile(signature)
    return dispatcher


def is_compiled(dispatcher: Any, signature: Any) -> bool:
    """Whether a function needs no compiling for arguments of these types: it is in memory or on disk."""
    if CACHE is None or signature in dispatcher.overloads:
        return signature in dispatcher.overloads
    return bool(internals().cache_of(dispatcher).contains(signature, dispatcher.targetctx))


def internals() -> Any:
    """Return the module of numba's private interfaces, which must not be imported where they are not as expected."""
    return import_module("minirt.kernel.compiler.numba_internals")
