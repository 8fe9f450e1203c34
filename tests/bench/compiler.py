"""Compile the C++ of the benchmark for the processor at hand."""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection
from pathlib import Path

from tests.bench.system import INSTALL, MissingError
from tests.processes import run

FLAGS = [
    "-std=c++20",
    "-O3",
    "-march=native",
    "-fopenmp",
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-fno-trapping-math",
]


def compiled(target: Path, sources: Collection[Path], headers: Collection[Path], name: str, *flags: str) -> Path:
    """Compile sources into `target` unless it is newer than they; `MissingError` without a suitable compiler."""
    if target.exists() and target.stat().st_mtime > max(each.stat().st_mtime for each in (*sources, *headers)):
        return target
    compiler = os.environ.get("CXX") or next(filter(shutil.which, ("g++", "clang++", "c++")), None)
    if compiler is None:
        raise MissingError(f"{name}: no C++ compiler is installed; {INSTALL}")
    target.parent.mkdir(parents=True, exist_ok=True)
    ran = run([*compiler.split(), *FLAGS, *flags, *map(str, sorted(sources)), "-o", str(target)], text=True)
    if ran.returncode:
        raise MissingError(f"{name}: {compiler} cannot compile it: {ran.stderr.strip().splitlines()[0]}")
    return target
