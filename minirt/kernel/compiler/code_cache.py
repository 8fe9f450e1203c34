"""Cache of compiled kernels on disk: machine code alone.

numba also writes LLVM code, for other compiled functions to link, looks for a cached function only when all that a
compiler needs is loaded, and holds machine code in memory until the program ends. Only Python calls a kernel, and an
editor meets ever new combinations of shapes: so machine code alone is written, it is loaded without a compiler, and
each kernel has an engine of its own, whose memory is freed with the last reference to the kernel.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from minirt.kernel.compiler.cache_folder import locked
from minirt.kernel.compiler.numba_internals import DiskCache, Serializer, keep_names_only, with_own_engine


class MachineCode(Serializer):
    """Machine code of a kernel as bytes, and back."""

    def reduce(self, compiled: Any) -> Any:
        """Return what is written for a compiled function."""
        keep_names_only(compiled.library)
        return super().reduce(compiled)

    def rebuild(self, target: Any, written: Any) -> Any:
        """Return a function that can be called."""
        return super().rebuild(with_own_engine(target), written)


class CodeCache(DiskCache):
    """Writes and finds the machine code of a kernel."""

    serializer = MachineCode

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Write the machine code, one process at a time."""
        with locked(Path(self.cache_path)):
            super().save_overload(signature, compiled)
