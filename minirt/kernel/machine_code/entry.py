"""Entry points of loaded kernels: called with Python values, through one address of memory, without the interpreter's
lock."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from minirt.kernel.machine_code.argument_block import words_of

ENTRY = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


class Entry:
    """A loaded kernel for one signature. The code lives as long as this object."""

    def __init__(self, address: int, results: int, code: object) -> None:
        """`address` of the entry point; `results`: integers that the kernel returns; `code` owns the machine code."""
        self.results = results
        self.code = code
        self.call = ENTRY(address)

    def __call__(self, *arguments: Any) -> Any:
        """Run the kernel, and return its result: None, an integer, or a tuple of them."""
        return self.run(words_of(arguments))

    def run(self, words: list[int]) -> Any:
        """Run the kernel with the words of its arguments, which the caller keeps alive."""
        block = np.array(words + [0] * self.results, np.int64)
        self.call(block.ctypes.data)
        results = block[len(words) :].tolist()
        return tuple(results) if self.results > 1 else results[0] if results else None
