"""The machine and the package versions that the figures of a report depend on."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import minirt

PACKAGES = ("numpy", "numba", "llvmlite", "pillow")


def processor() -> str:
    """Return the name of the processor: from /proc/cpuinfo on Linux, from `platform` elsewhere."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(": ")[1] for line in lines if line.startswith("model name")), platform.processor())


def versions() -> dict[str, str]:
    """Return the versions of miniRT, of Python and of the packages that compute or draw."""
    found = {"minirt": minirt.__version__, "python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found
