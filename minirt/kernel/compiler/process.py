"""Compiles a kernel in a process of its own, beside a window that must not wait: `python -m minirt.kernel.compiler.process`.

Standard input has the arguments that the kernel will be called with, pickled; it stays open for as long as somebody
waits for the kernel. What is compiled is kept (`minirt.kernel.compiler.cache_folder`).
"""

from __future__ import annotations

import gc
import os
import pickle
import sys
from importlib import import_module
from subprocess import Popen
from threading import Thread

LISTS = [sys.executable, "-P", "-m", "minirt.kernel.compiler.process", "lists"]


def main() -> None:
    """Compile, or end as soon as nobody waits. Another process makes what makes the lists at the same time."""
    gc.disable()  # a tenth less time
    if sys.argv[1:] == LISTS[-1:]:
        Thread(target=leave_at_end_of_input, daemon=True).start()
        import_module("minirt.kernel.compiler.jit_binning")  # which compiles as it is imported
        os._exit(0)
    arguments = pickle.load(sys.stdin.buffer)
    Thread(target=leave_at_end_of_input, daemon=True).start()
    with Popen(LISTS) as beside:
        from minirt.kernel.compiler import jit

        jit.compile(arguments)
    os._exit(beside.returncode)  # to give back what the compiler took would need a tenth of the time


def leave_at_end_of_input() -> None:
    """Whoever started this process closed the pipe, or was killed."""
    os.read(sys.stdin.fileno(), 1)
    os._exit(1)


if __name__ == "__main__":
    main()
