"""Fingerprint of compiled kernels: a hash of the sources and of the processor that they were compiled for.

That processor is a level of x86-64, whose code many processors can run, or the very one of this machine. Code for level
v4, which has AVX-512, was measured to be as fast as code for the very processor; level v3 has AVX2 and FMA. The levels
are those of the x86-64 psABI.
"""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from functools import cache
from pathlib import Path

V4, V3, NATIVE = "x86-64-v4", "x86-64-v3", "native"
# Flags in /proc/cpuinfo; bmi1, f16c and others come with these.
NEEDED = {
    V4: {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
    V3: {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"},
}
CPUINFO = Path("/proc/cpuinfo")
PACKAGE = Path(__file__).parents[2]
SOURCES = ("kernel", "lanes", "meshes", "shapes")  # folders of all sources of a kernel


@cache
def fingerprint_of(target: str) -> str:
    """Return a hash of the sources and of the processor `target`, a name such as `processor` returns: 16 digits.

    A package without sources has modules of bytecode beside its folders; one in a zip file stands for the whole file.
    """
    digest = hashlib.sha256(described(target).encode())
    if not PACKAGE.is_dir():
        digest.update(next(parent for parent in PACKAGE.parents if parent.is_file()).read_bytes())
    for folder in SOURCES:
        for parent, folders, names in os.walk(PACKAGE / folder):  # `Path.rglob` takes 8 ms of each start
            folders[:] = sorted(name for name in folders if name != "__pycache__")  # those that `os.walk` enters
            for name in sorted(name for name in names if name.endswith((".py", ".pyc"))):
                digest.update(name.encode() + b"\0" + Path(parent, name).read_bytes())
    return digest.hexdigest()[:16]


def processor() -> str:
    """Return the name of the processor to compile for: NUMBA_CPU_NAME, or a level, or NATIVE where there is none."""
    return os.environ.get("NUMBA_CPU_NAME") or level()


def described(name: str) -> str:
    """Return a text that differs for processors that need different machine code."""
    if name == NATIVE:
        name = f"{platform.machine()} {platform.processor()} {cpu_information('model name')}"
    return f"{sys.platform} {name}"


@cache
def level() -> str:
    """Return the highest level of x86-64 that this machine has; NATIVE on others."""
    return level_of(set(cpu_information("flags").split())) if is_linux_on_x86_64() else NATIVE


def is_linux_on_x86_64() -> bool:
    """Whether kernels can be compiled for the levels of x86-64 and run here."""
    return sys.platform == "linux" and platform.machine() == "x86_64"


def level_of(flags: set[str]) -> str:
    """Return the highest level that a processor with these flags has."""
    if not NEEDED[V3] <= flags:
        return NATIVE
    return V4 if NEEDED[V4] <= flags else V3


def cpu_information(label: str) -> str:
    """Return what /proc/cpuinfo says of the first processor; nothing where it cannot be read."""
    try:
        with CPUINFO.open(encoding="ascii", errors="replace") as lines:
            return next((line.partition(":")[2].strip() for line in lines if line.startswith(label)), "")
    except OSError:
        return ""
