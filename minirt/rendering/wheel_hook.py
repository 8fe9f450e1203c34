"""Build hook of hatchling: example scenes for wheels and, on x86-64 Linux, generic kernels compiled ahead of time.

The kernels fit every such machine whose processor has level v3 or v4 of x86-64, and every version of Python.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

TAG = "py3-none-manylinux_2_17_x86_64"  # the kernels need no library at all


class ScenesAndKernels(BuildHookInterface):  # type: ignore[misc]
    """Compiles before the files of a wheel are collected; `artifacts` in pyproject.toml names the results."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add them before files are collected, unless the installation is editable: there `make all` compiles."""
        if version == "editable":
            return
        build_data["force_include"][str(Path(self.root, "scenes"))] = "minirt/scenes"  # `minirt.example`
        sys.path.insert(0, self.root)
        from minirt.errors import MiniRTError
        from minirt.kernel.machine_code.cache import SHIPPED
        from minirt.kernel.machine_code.fingerprint import V3, V4, is_linux_on_x86_64
        from minirt.rendering.ahead_of_time import build

        if not is_linux_on_x86_64():
            return
        try:
            for level in (V3, V4):
                build(Path(SHIPPED, level), level)
        except MiniRTError as error:
            self.app.display_warning(f"the wheel has no kernels, programs will compile them: {error}")
            return
        build_data["pure_python"] = False
        build_data["tag"] = TAG
