"""Copies of functions which report their calls: they tell what a formula computes on its way."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any


def watched(module: ModuleType, reports: dict[str, Callable[..., None]], **others: Any) -> SimpleNamespace:
    """Return copies of the functions of a module which call one another, and `others` by their names.

    A call of a function in `reports` is followed by one of its report, with the result and the arguments.
    """
    names = vars(module) | others
    for name, each in vars(module).items():
        if isinstance(each, FunctionType) and each.__module__ == module.__name__:
            names[name] = FunctionType(each.__code__, names, name, each.__defaults__, each.__closure__)
    names |= {name: reporting(names[name], report) for name, report in reports.items()}
    return SimpleNamespace(**names)


def reporting(function: Callable[..., Any], report: Callable[..., None]) -> Callable[..., Any]:
    def call(*arguments: Any) -> Any:
        result = function(*arguments)
        report(result, *arguments)
        return result

    return call
