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


def by_time(points: Iterable[Setting]) -> list[Setting]:
    """Those that did not fail, the fastest first."""
    measured = [point for point in points if isfinite(point.rmse) and isfinite(point.wall_ms)]
    return sorted(measured, key=lambda point: (point.wall_ms, point.rmse))


def front(points: Iterable[Setting], doubt: float) -> list[Setting]:
    """Those of which no other is both as fast and as close, the fastest first. Who takes longer has to be closer by
    more than the `doubt` about errors."""
    best: list[Setting] = []
    for point in by_time(points):
        if not best or point.rmse < best[-1].rmse - doubt:
            best.append(point)
    return best


def fastest(points: Iterable[Setting], rmse: float) -> Setting | None:
    """The fastest whose error is at most so large; None where no one's is."""
    return next((point for point in by_time(points) if point.rmse <= rmse), None)


def closest(points: Iterable[Setting], wall_ms: float, doubt: float) -> Setting | None:
    """The one of the front with the least error in at most so much time; None where no one is that fast."""
    return next((point for point in reversed(front(points, doubt)) if point.wall_ms <= wall_ms), None)
