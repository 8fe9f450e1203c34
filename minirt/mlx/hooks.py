"""Hooks: the functions that a program sets to be called on events."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

Hook: TypeAlias = Callable[..., object]  # its last argument is the parameter given with it
BoundHook: TypeAlias = tuple[Hook, object]  # a hook and its parameter


def bound(callback: Hook | None, param: object) -> BoundHook | None:
    """Return the hook with its parameter, or None for none."""
    return (callback, param) if callback else None


def set_hook(hooks: dict[int, BoundHook], event: int, callback: Hook | None, param: object) -> int:
    """Set the one hook of an event, or remove it; return 0 as MiniLibX does."""
    if callback:
        hooks[event] = (callback, param)
    else:
        hooks.pop(event, None)
    return 0
