"""Compiles a kernel in a process of its own, beside a window that must not wait: `python -m minirt.kernel.compile`.

Standard input has the arguments that the kernel will be called with, pickled; it stays open for as long as somebody
waits for the kernel. What is compiled is kept (`minirt.kernel.cache`).
"""

from __future__ import annotations

import gc
import os
import pickle
import sys
from importlib import import_module
from threading import Thread


def main() -> None:
    """Compile, or end as soon as nobody waits."""
    arguments = pickle.load(sys.stdin.buffer)
    Thread(target=leave_at_end_of_input, daemon=True).start()
    gc.disable()  # a tenth less time
    from minirt.kernel import jit

    import_module("minirt.kernel.jit_lists")  # which compiles as it is imported
    jit.compile(arguments)


def leave_at_end_of_input() -> None:
    """Whoever started this process closed the pipe, or was killed."""
    os.read(sys.stdin.fileno(), 1)
    os._exit(1)


if __name__ == "__main__":
    main()
