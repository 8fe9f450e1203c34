"""Count the operations of a formula for a packet of rays while it is interpreted: the same on every processor.

A packet is what the compiled formula works on too, and what a formula skips for all rays of one is not counted. Numbers
of the shape alone, which are the same for all rays of the packet, count nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import numpy as np

from minirt.lanes import Vec
from tests.oracle.random_rays import Rays

PACKET = 16  # rays of float64
FAST = {
    *("add", "subtract", "multiply", "negative", "fabs", "absolute", "copysign"),
    *("less", "less_equal", "greater", "greater_equal", "equal", "not_equal"),
    *("bitwise_and", "bitwise_or", "bitwise_xor", "invert", "where", "any", "full_like"),
}


class Work(NamedTuple):
    """Mean number of operations of a formula for a packet of rays."""

    all: float
    slow: float  # divisions, roots and all other operations that are not in `FAST`


class Counted(np.ndarray[Any, Any]):
    """An array that counts its operations by their numpy names."""

    operations: ClassVar[Counter[str]] = Counter()

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        self.operations[ufunc.__name__] += 1
        return counted(getattr(ufunc, method)(*map(plain, inputs), **options))

    def __array_function__(self, function: Any, types: Any, inputs: Any, options: Any) -> Any:
        self.operations[function.__name__] += 1
        return counted(function(*map(plain, inputs), **options))


def counted(x: Any) -> Any:
    """Return a number for each ray as an array that counts its operations."""
    return x.view(Counted) if isinstance(x, np.ndarray) else x


def plain(x: Any) -> Any:
    """Return a number for each ray as a plain array."""
    return np.asarray(x) if isinstance(x, Counted) else x


def work(formula: Callable[..., Any], rays: Rays) -> Work:
    """Count the operations of a formula, such as `Kind.intersect`, for some rays."""
    Counted.operations.clear()
    packets = 0
    for shape, *each in zip(*rays, strict=True):
        for start in range(0, len(each[0]), PACKET):
            origin, direction = (Vec(*map(counted, part[start : start + PACKET].T.copy())) for part in each)
            with np.errstate(all="ignore"):
                formula(shape.pack(), origin, direction)
            packets += 1
    found = Counted.operations
    slow = sum(count for name, count in found.items() if name not in FAST)
    return Work(sum(found.values()) / packets, slow / packets)
