"""Makes `os.fork()` wait until no thread compiles: a child process could not go on with a half-made kernel.

Compiling threads hold numba's lock. The forking thread takes it too, and releases it in both processes.
"""

from __future__ import annotations

import os

from numba.core.compiler_lock import global_compiler_lock

if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(
        before=global_compiler_lock.acquire,
        after_in_parent=global_compiler_lock.release,
        after_in_child=global_compiler_lock.release,
    )
