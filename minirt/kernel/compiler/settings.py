"""Settings of numba, in environment variables or its configuration file, with which nothing can be compiled."""

from __future__ import annotations

import os


def unusable_setting() -> str | None:
    """Say which setting must be changed, and why; None where all will do."""
    try:
        from numba import config
    except Exception as error:  # such as ValueError for NUMBA_NUM_THREADS=0
        variables = (f"{name}={value}" for name, value in os.environ.items() if name.startswith("NUMBA_"))
        return f"the compiler numba does not start, change its settings: {error} ({', '.join(variables)})"
    if config.DISABLE_JIT:
        return "NUMBA_DISABLE_JIT turns off the compiler, without which nothing can be rendered: unset it"
    return None
