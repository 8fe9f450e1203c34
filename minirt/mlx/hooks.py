"""Hooks: the functions that a program sets to be called on events."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

Hook: TypeAlias = Callable[..., object]  # its last argument is the parameter given with it
BoundHook: TypeAlias = tuple[Hook, object]  # a hook and its parameter
