"""Program that compiles a kernel into the cache on disk, so that a window need not wait.

`python -m minirt.kernel.compiler.process` reads the pickled arguments of the kernel from standard input, and ends when
that is closed: then nobody waits for the kernel any more.
"""

from __future__ import annotations

import gc
import os
import pickle
import sys
from importlib import import_module
from subprocess import Popen
from threading import Thread

BINNING = "binning"  # argument: compile the binning of shapes instead of a kernel
COMPILE_BINNING = [sys.executable, "-P", "-m", "minirt.kernel.compiler.process", BINNING]


def main() -> None:
    """Compile a kernel, and in a second process at the same time the binning of shapes."""
    gc.disable()  # saves a tenth of the time
    if sys.argv[1:] == [BINNING]:
        Thread(target=exit_at_end_of_input, daemon=True).start()
        import_module("minirt.kernel.compiler.jit_binning")  # compiles at import
        os._exit(0)
    arguments = pickle.load(sys.stdin.buffer)
    Thread(target=exit_at_end_of_input, daemon=True).start()
    with Popen(COMPILE_BINNING) as second:
        from minirt.kernel.compiler import jit

        jit.compile(arguments)
    os._exit(second.returncode)  # freeing the compiler's memory would take a tenth of the time


def exit_at_end_of_input() -> None:
    """End this process when standard input is closed, as it is when the parent process ends."""
    os.read(sys.stdin.fileno(), 1)
    os._exit(1)


if __name__ == "__main__":
    main()
