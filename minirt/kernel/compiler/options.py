"""Options with which numba compiles kernels and the functions that they call.

`FLAGS` are for a kernel, `INLINED` for the functions that it calls. Importing this module checks numba's private
interfaces (`minirt.kernel.compiler.numba_internals`). Where one has changed, numba's documented means are used instead:
kernels take about twice as long to compile; pictures are the same.
"""

from __future__ import annotations

import logging
from importlib import import_module
from typing import Any

import numba


def failed_assumption() -> str | None:
    """Return the name of a private interface of numba that has changed; None where all are as expected."""
    try:
        failed: str | None = import_module("minirt.kernel.compiler.numba_internals").failed_assumption()
    except (ImportError, AttributeError) as error:
        return str(error)
    return failed


def inlined_compiler() -> Any:
    """Return the compiler of functions that are inlined into kernels."""
    if FAILED:
        return import_module("minirt.kernel.compiler.documented_pipeline").InlinedCompiler
    return import_module("minirt.kernel.compiler.lean_pipeline").InlinedCompiler


TESTED = "numba<0.69"
FAILED = failed_assumption()
if FAILED:
    logging.getLogger(__name__).warning(
        "notice: kernels take twice as long to compile, as numba %s differs from what was tested (%s); "
        "pip install '%s' mends that",
        numba.__version__,
        FAILED,
        TESTED,
    )

# error_model: x / 0 is infinite or NaN, as in IEEE 754. fastmath: a * b + c may round once, and nothing else.
FLAGS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True}
if not FAILED:
    FLAGS["_nrt"] = False  # The kernel allocates nothing: no reference counting.

# Without wrappers for calls from Python there is 20 % less to compile. A call passes vectors through memory: inlined,
# functions are 1.5 to 2 times as fast.
INLINED: dict[str, Any] = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "forceinline": True,
    "no_rewrites": True,
    "pipeline_class": inlined_compiler(),
}
