"""Compiles kernels in other processes, so that this one neither waits nor imports the compiler."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import suppress
from threading import Thread

from minirt.errors import RenderError
from minirt.kernel.machine_code.cache import ObjectCode, notice, unpack
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
        """Return the object code of kernels, by their identities, for a processor, by default this one.

        A process that something else than `stop` kills, such as a lack of memory, is started once more. RenderError
        with the reason where compiling fails, or where `stop` ended it."""
        self.stopped = False
        status, output, messages = self.run(requests, target)
        if status < 0 and not self.stopped:
            status, output, messages = self.run(requests, target)
        if status:
            reason = messages[-1] if messages else f"the compiler ended with status {status}"
            raise RenderError(f"the kernel cannot be compiled: {reason}")
        for message in messages:
            notice(message)
        try:
            lines = map(bytes.fromhex, output.decode().split())
            return [unpack(request, line) for request, line in zip(requests, lines, strict=True)]
        except ValueError as error:
            raise RenderError(f"the kernel cannot be compiled: what the compiler wrote is damaged, {error}") from error

    def run(self, requests: list[str], target: str | None) -> tuple[int, bytes, list[str]]:
        """Run the process; return its exit status, its output and the lines of its standard error. RenderError where it
        cannot be started."""
        try:
            self.process = process = subprocess.Popen(
                (*COMMAND, *["--patient"] * self.patient),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=environment(target or processor()),
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            raise RenderError(f"the compiler cannot be started: {error}") from error
        errors = process.stderr
        assert process.stdin
        assert process.stdout
        assert errors
        with process:
            with suppress(BrokenPipeError):
                process.stdin.write(json.dumps(requests).encode() + b"\n")
                process.stdin.flush()
            written: list[bytes] = []
            reader = Thread(target=lambda: written.append(errors.read()))  # else the process waits with a full pipe
            reader.start()
            output = process.stdout.read()
            reader.join()
        return process.returncode, output, written[0].decode(errors="replace").strip().splitlines()

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
