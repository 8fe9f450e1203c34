"""Signatures: the types of a kernel's arguments, as plain data that JSON can hold.

Arrays are C-contiguous. A scene has few signatures and a call must be quick, so that a signature is looked up by a key.
"""

from __future__ import annotations

from collections.abc import Hashable
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np

Signature: TypeAlias = Any  # None, "int", "float", {"array": dtype, "ndim": n} or {"tuple": class, "items": [...]}


def key_of(value: Any) -> Hashable:
    """Return a key that two values share only where they have the same signature."""
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim
    if isinstance(value, tuple):
        return (type(value), *map(key_of, value))
    return (type(value),)


def signature_of(value: Any) -> Signature:
    """Return the signature of a value; TypeError for what no kernel takes."""
    if value is None:
        return None
    if isinstance(value, np.ndarray):
        return {"array": value.dtype.descr if value.dtype.names else value.dtype.str, "ndim": value.ndim}
    if isinstance(value, tuple):
        kind = type(value)
        return {"tuple": f"{kind.__module__}:{kind.__qualname__}", "items": [signature_of(each) for each in value]}
    if isinstance(value, int | np.integer):
        return "int"
    if isinstance(value, float):
        return "float"
    raise TypeError(f"no kernel takes {type(value).__name__}")


def tuple_class(signature: Signature) -> type[tuple[Any, ...]]:
    """Return the class of a tuple, by its signature."""
    module, name = signature["tuple"].split(":")
    found: type[tuple[Any, ...]] = getattr(import_module(module), name)
    return found


def dtype_of(signature: Signature) -> np.dtype[Any]:
    """Return the dtype of an array, by its signature, which JSON may have turned from tuples to lists."""
    kind = signature["array"]
    return np.dtype(kind if isinstance(kind, str) else [field(*each) for each in kind])


def field(name: str, kind: str, shape: tuple[int, ...] = ()) -> tuple[str, str, tuple[int, ...]]:
    """Return the description of a field of a record."""
    return name, kind, tuple(shape)
