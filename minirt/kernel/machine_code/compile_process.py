"""Compiles kernels in other processes, so that this one neither waits nor imports the compiler."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
from contextlib import suppress

from minirt.errors import RenderError
from minirt.kernel.machine_code.cache import ObjectCode, notice
from minirt.kernel.machine_code.fingerprint import NATIVE, V3, V4, processor

# With -P nothing is imported from the current folder.
COMMAND = (sys.executable, "-P", "-c", "from minirt.kernel.compiler import main; main()")
FEATURES = {V4: "+avx512f", V3: ""}  # what NUMBA_CPU_FEATURES adds to those that a level has


class CompileProcess:
    """Compiles one list of kernels at a time."""

    def __init__(self, patient: bool = False) -> None:
        """`patient`: with the lowest priority, while this process renders."""
        self.patient = patient
        self.process: subprocess.Popen[bytes] | None = None
        self.stopped = False  # whether `stop` has been called since compiling began

    def compile(self, requests: list[str], target: str | None = None) -> list[ObjectCode]:
        """Return the object code of the kernels whose identities are `requests`, in their order.

        `target` is the name of a processor, by default this one. A process that something else than `stop` kills, such
        as a lack of memory, is started once more. What the compiler writes to its standard error becomes notices.
        RenderError with the reason where compiling fails, or where `stop` ended it."""
        self.stopped = False
        status, output, errors = self.run(requests, target)
        was_killed = status < 0
        if was_killed and not self.stopped:
            status, output, errors = self.run(requests, target)
        messages = errors.decode(errors="replace").strip().splitlines()
        if status:
            reason = messages[-1] if messages else f"the compiler ended with status {status}"
            raise RenderError(f"the kernel cannot be compiled: {reason}")
        for message in messages:
            notice(message)
        compiled: list[ObjectCode] = pickle.loads(output)
        return compiled

    def run(self, requests: list[str], target: str | None) -> tuple[int, bytes, bytes]:
        """Run the compiler in a process, `self.process`, which others may stop; arguments are those of `compile`.

        Returns the exit status, the output and the standard error. RenderError where the process cannot be started."""
        try:
            self.process = process = subprocess.Popen(
                (*COMMAND, *(["--patient"] if self.patient else [])),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=environment(target or processor()),
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            raise RenderError(f"the compiler cannot be started: {error}") from error
        requests_pipe, process.stdin = process.stdin, None  # `communicate` would close it, at which the compiler ends
        assert requests_pipe
        with process, requests_pipe:
            with suppress(BrokenPipeError):
                requests_pipe.write(json.dumps(requests).encode() + b"\n")
                requests_pipe.flush()
            output, errors = process.communicate()
        return process.returncode, output, errors

    def stop(self) -> None:
        """Kill the process, if there is one; callable from any thread."""
        self.stopped = True
        if self.process:
            self.process.kill()


def environment(target: str) -> dict[str, str]:
    """Return the environment of a process that compiles for a processor, free of settings for other uses of numba."""
    inherited = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    chosen = {"NUMBA_DISABLE_JIT": "0", "PYTHONPATH": os.pathsep.join(each or os.curdir for each in sys.path)}
    if target != NATIVE:
        chosen |= {"NUMBA_CPU_NAME": target, "NUMBA_CPU_FEATURES": FEATURES.get(target, "")}
    return inherited | chosen
