"""The compiler of kernels, and the program that runs it, so that no other program need import it.

The program reads a line from standard input, a JSON list of identities of kernels as
`minirt.kernel.machine_code.library.identity_of` makes them, and pickles the list of their object code to standard
output. It ends when standard input is closed: then nobody waits for the kernels any more.
"""

from __future__ import annotations

import gc
import json
import os
import pickle
import sys
from threading import Thread

LOWEST_PRIORITY = 19


def main() -> None:
    """Compile kernels. With `--patient` the process gives way to all others."""
    gc.disable()  # saves a tenth of the time
    if "--patient" in sys.argv and hasattr(os, "nice"):
        os.nice(LOWEST_PRIORITY)
    requests = json.loads(sys.stdin.buffer.readline())
    Thread(target=exit_at_end_of_input, daemon=True).start()
    from minirt.kernel.compiler.object_code import object_code

    pickle.dump([object_code(*json.loads(identity)[:2]) for identity in requests], sys.stdout.buffer)
    sys.stdout.flush()
    os._exit(0)  # freeing the compiler's memory would take a tenth of the time


def exit_at_end_of_input() -> None:
    """End this process when standard input is closed, as it is when the parent process ends."""
    os.read(sys.stdin.fileno(), 1)
    os._exit(1)
