"""Importing compiled functions, and with them the compiler."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from minirt.errors import RenderError


def compiler_module(name: str) -> Any:
    """Import a module of `minirt.kernel.compiler`; RenderError where the settings of the compiler do not allow it."""
    unusable = import_module("minirt.kernel.compiler.settings").unusable_setting()
    if unusable:
        raise RenderError(unusable)
    return import_module(f"minirt.kernel.compiler.{name}")
