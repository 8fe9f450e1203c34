"""Pareto front of the settings, and the best setting for a given error or time."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Protocol, TypeVar


class Point(Protocol):
    """Error and time of a setting; NaN if it failed."""

    @property
    def rmse(self) -> float: ...

    @property
    def wall_ms(self) -> float: ...


Setting = TypeVar("Setting", bound=Point)


def by_time(points: Iterable[Setting]) -> list[Setting]:
    """Return the settings that did not fail, the fastest first."""
    measured = [point for point in points if isfinite(point.rmse) and isfinite(point.wall_ms)]
    return sorted(measured, key=lambda point: (point.wall_ms, point.rmse))


def pareto_front(points: Iterable[Setting], doubt: float) -> list[Setting]:
    """Return the Pareto front, the fastest first: each slower setting has an error smaller by more than `doubt`."""
    best: list[Setting] = []
    for point in by_time(points):
        if not best or point.rmse < best[-1].rmse - doubt:
            best.append(point)
    return best


def fastest(points: Iterable[Setting], rmse: float) -> Setting | None:
    """Return the fastest setting with an error of at most `rmse`; None if there is none."""
    return next((point for point in by_time(points) if point.rmse <= rmse), None)


def closest(points: Iterable[Setting], wall_ms: float, doubt: float) -> Setting | None:
    """Return the most accurate setting that takes at most `wall_ms`; None if there is none."""
    return next((point for point in reversed(pareto_front(points, doubt)) if point.wall_ms <= wall_ms), None)
