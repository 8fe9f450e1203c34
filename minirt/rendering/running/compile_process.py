"""Compiles kernels in another process, so that this one stays responsive."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from contextlib import suppress
from typing import Any

from minirt.errors import RenderError

# With -P nothing is imported from the current folder.
COMMAND = (sys.executable, "-P", "-m", "minirt.kernel.compiler.process")


class CompileProcess:
    """Compiles one kernel at a time."""

    process: subprocess.Popen[bytes] | None = None

    def compile(self, arguments: tuple[Any, ...]) -> None:
        """Compile the kernel for arguments of these types into the cache on disk; do nothing if no process can start.

        RenderError with the reason where compiling fails, or where `stop` ended it."""
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(each or os.curdir for each in sys.path)}
        try:
            self.process = process = subprocess.Popen(
                COMMAND,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                env=environment,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError:
            return
        assert process.stdin is not None
        assert process.stderr is not None
        with process:
            with suppress(BrokenPipeError):
                process.stdin.write(pickle.dumps(arguments))
                process.stdin.flush()
            output = process.stderr.read().decode(errors="replace").strip()
        if process.returncode:
            reason = output.splitlines()[-1] if output else f"the compiler ended with status {process.returncode}"
            raise RenderError(f"the kernel cannot be compiled: {reason}")

    def stop(self) -> None:
        """Kill the process, if there is one; callable from any thread."""
        if self.process:
            self.process.kill()
