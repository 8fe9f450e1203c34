"""Atomic counter by which threads share out work."""

from __future__ import annotations

from typing import Any


def fetch_add(counter: Any, amount: int) -> int:
    """Add to a counter that threads share, and return its value from before; compiled, this is atomic."""
    before = int(counter[0])
    counter[0] += amount
    return before
