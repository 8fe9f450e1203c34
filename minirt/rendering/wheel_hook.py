"""Build hook of hatchling: a wheel has the example scenes, and the kernels that were compiled for it before.

The hook compiles nothing: pip runs it, without a word, to learn what a project depends on. `make wheel` compiles the
generic kernels for levels v3 and v4 of x86-64 before. They fit every version of Python.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

TAG = "py3-none-manylinux_2_17_x86_64"  # the kernels need no library at all


class ScenesAndKernels(BuildHookInterface):  # type: ignore[misc]
    """Runs before the files of a wheel are collected; `artifacts` in pyproject.toml names the kernels."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the scenes, and the tag that kernels need, unless the installation is editable."""
        if version == "editable":
            return
        build_data["force_include"][str(Path(self.root, "scenes"))] = "minirt/scenes"  # `minirt.example`
        if any(Path(self.root, "minirt/kernel/ahead_of_time").glob("x86-64-v*/*.kernel")):
            build_data["pure_python"] = False
            build_data["tag"] = TAG
