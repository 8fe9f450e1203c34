"""Numbers in memory that the processor reads ahead, and as many as one of its registers holds."""

from __future__ import annotations

from typing import Any

from minirt.lanes import Number, width


def load_half(values: Any, start: int) -> Number:
    """Load half as many float32 as a packet has rays, from index `start` on: as many as a register of AVX-512 holds."""
    return values[start : start + width(values) // 2].copy()


def prefetch(values: Any, start: int) -> None:
    """Let the processor load the numbers around index `start` of an array into its cache, without waiting for them."""
