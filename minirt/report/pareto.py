"""Which setting to take."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Protocol, TypeVar


class Point(Protocol):
    """What a setting costs and how wrong it is; NaN where it failed."""

    @property
    def rmse(self) -> float: ...

    @property
    def wall_ms(self) -> float: ...


Setting = TypeVar("Setting", bound=Point)


def front(points: Iterable[Setting]) -> list[Setting]:
    """Those of which no other is both as fast and as close, the fastest first. Of equal ones the first stays."""
    best: list[Setting] = []
    measured = [point for point in points if isfinite(point.rmse) and isfinite(point.wall_ms)]
    for point in sorted(measured, key=lambda point: (point.wall_ms, point.rmse)):
        if not best or point.rmse < best[-1].rmse:
            best.append(point)
    return best


def fastest(points: Iterable[Setting], rmse: float) -> Setting | None:
    """The fastest whose error is at most so large; None where no one's is."""
    return next((point for point in front(points) if point.rmse <= rmse), None)


def closest(points: Iterable[Setting], wall_ms: float) -> Setting | None:
    """The one with the least error in at most so much time; None where no one is that fast."""
    return next((point for point in reversed(front(points)) if point.wall_ms <= wall_ms), None)
