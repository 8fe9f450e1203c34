"""A counter by which threads share work."""

from __future__ import annotations

from typing import Any


def fetch_add(counter: Any, amount: int) -> int:
    """Add to a counter that threads share, and return what it was before."""
    before = int(counter[0])
    counter[0] += amount
    return before
