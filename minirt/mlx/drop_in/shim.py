"""The modules `mlx` and `mlx.mlx`, as the official wrapper has them, inside this process only."""

from __future__ import annotations

import sys
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TYPE_CHECKING

from minirt.errors import MlxError
from minirt.mlx.api import Mlx
from minirt.mlx.backend import ADVICE
from minirt.mlx.options import MaybeNone, integer

if TYPE_CHECKING:
    from minirt.mlx.backend import Backend
    from minirt.mlx.options import Integer
    from minirt.mlx.window import Window, WindowHost


def install(backend: Backend | None, *, strict: bool) -> None:
    """Make `from mlx import Mlx` import our class, with this back end and option, even if the wrapper is installed."""

    class WrapperMlx(Mlx):
        def __init__(self) -> None:
            super().__init__(backend, strict=strict)

        def mlx_string_put(
            self, mlx_ptr: WindowHost, win_ptr: Window, x: Integer, y: Integer, color: Integer, string: str
        ) -> int:
            """Draw text in a colour 0xBBGGRR: in text, and only there, the wrapper's shader takes blue for red."""
            word = integer(color)
            swapped = (word & 0xFF) << 16 | word & 0xFF00 | word >> 16 & 0xFF
            return super().mlx_string_put(mlx_ptr, win_ptr, x, y, swapped, string)

        def _mlx_failed(self, error: MlxError) -> MaybeNone:
            return super()._mlx_failed(MlxError(str(error).replace(ADVICE, "--headless runs without one")))

    WrapperMlx.__name__ = WrapperMlx.__qualname__ = "Mlx"
    WrapperMlx.__module__ = "mlx.mlx"
    package, module = _module("mlx", is_package=True), _module("mlx.mlx")
    for target in (package, module):
        target.Mlx = WrapperMlx  # type: ignore[attr-defined]
    package.mlx = module  # type: ignore[attr-defined]


def _module(name: str, *, is_package: bool = False) -> ModuleType:
    """Make an empty module and register it."""
    module = ModuleType(name)
    module.__spec__ = ModuleSpec(name, None, is_package=is_package)
    if is_package:
        module.__path__ = []
    sys.modules[name] = module
    return module
