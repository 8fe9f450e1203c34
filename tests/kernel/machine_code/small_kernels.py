"""Two functions that compile in a moment, kept in a folder as kernels are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from minirt.kernel.compiler.compilation import compiled
from numba import float64

from minirt.kernel.compiler.numba_internals import cache_of

ARGUMENT = 1.5
TYPES = (float64,)


def double(x: Any) -> Any:
    return x + x


def square(x: Any) -> Any:
    return x * x


def is_found(function: Any, folder: Path) -> bool:
    """Compile or load a small kernel and return whether it was loaded. Its result is always right."""
    kernel = compiled(function, folder, TYPES)
    assert kernel(ARGUMENT) == function(ARGUMENT)
    return sum(kernel.stats.cache_hits.values()) == 1


def file_of(function: Any, folder: Path) -> Path:
    """Return the path of the file of a small kernel."""
    dispatcher = compiled(function, folder)
    cache = cache_of(dispatcher)
    path: Path = cache.file_of(cache.identity(TYPES, dispatcher.targetctx))
    return path
