"""Arguments of kernels: their signatures, plain data that JSON can hold, and the 64-bit words that a kernel reads.

The compiler lays a tuple out as its items one after the other, and an array, which is C-contiguous, as seven words or
more: two that are 0 here, the number of items, bytes of an item, address of the data, shape and strides. There is no
padding, as all of them have 64 bits. A kernel returns nothing: it writes its results into arrays.
"""

from __future__ import annotations

import struct
from collections.abc import Hashable
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np

Signature: TypeAlias = Any  # None, "int", "float", {"array": dtype, "ndim": n} or {"tuple": class, "items": [...]}


def words_of(value: Any) -> bytes:
    """Return the words of an argument, or of a tuple of arguments. ValueError for an array that is not C-contiguous."""
    words: list[int] = []
    append_words(words, value)
    return struct.pack(f"={len(words)}q", *words)


def append_words(words: list[int], value: Any) -> None:
    """Append to `words` those of an argument: None, an array, a tuple of arguments, or a number.

    ValueError for an array that is not C-contiguous.
    """
    if value is None:
        words.append(0)
    elif isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise ValueError("an array for a kernel must be C-contiguous")
        words += 0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides
    elif isinstance(value, tuple):
        for item in value:
            append_words(words, item)
    elif isinstance(value, float):
        words += struct.unpack("=q", struct.pack("=d", value))
    else:
        words.append(int(value))


def key_of(value: Any) -> Hashable:
    """Return a key that two values share only where they have the same signature; it is found faster than that."""
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


def named(name: str) -> Any:
    """Return the function or the class of a name, "module:name"."""
    module, attribute = name.split(":")
    return getattr(import_module(module), attribute)


def dtype_of(signature: Signature) -> np.dtype[Any]:
    """Return the dtype of an array, by its signature, which JSON may have turned from tuples to lists."""
    kind = signature["array"]
    return np.dtype(kind if isinstance(kind, str) else [(name, of, tuple(*shape)) for name, of, *shape in kind])
