"""Argument blocks: the memory that a kernel finds its arguments in, a sequence of 64-bit words.

The compiler lays a tuple out as its items one after the other, and an array as seven words or more: two that are 0
here, the number of items, bytes of an item, address of the data, shape and strides. All of them are words of 64 bits,
so that there is no padding between them. The kernel stores its results, integers, in the words behind the arguments.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np


def words_of(value: Any) -> list[int]:
    """Return the words of an argument, or of a tuple of arguments. ValueError for an array that is not C-contiguous."""
    words: list[int] = []
    append_words(words, value)
    return words


def append_words(words: list[int], value: Any) -> None:
    """Append the words of an argument."""
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
