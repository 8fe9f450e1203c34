"""Immutable records: frozen dataclasses that share their methods.

`dataclass(frozen=True)` writes six methods of each class as text and compiles them. Records inherit these methods: a
class is made in a 28th of the time, 0.04 instead of 1.13 ms, and the program has fifty. An object is made in 1.5 times
the time, 6 us.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, FrozenInstanceError, dataclass, field, fields
from functools import cache
from operator import attrgetter
from typing import Any, TypeVar, cast, dataclass_transform

from minirt.record_help import FieldDocumentation, FieldSignature

Kind = TypeVar("Kind", bound="type[Immutable]")


def declare(
    kind: Callable[..., Any], doc: str, *, default: Any = None, shared: Mapping[str, Any] | None = None, **how: Any
) -> Any:
    """Declare an attribute of a record as a field of a scene: `diameter: float = declare(Length, "diameter")`.

    `kind` is the class of the field, `shared` are arguments that several fields have in common. For type checkers the
    `default` of a field that may be left out is written here, even where it is None, and no arguments are unpacked.
    """
    how = {**(shared or {}), **how}
    metadata = {"field": kind(doc=doc, default=default, **how)}
    required = default is None and not how.get("keyed")
    return field(metadata=metadata) if required else field(default=default, metadata=metadata)


@dataclass_transform(frozen_default=True, field_specifiers=(field, declare))
def record(*, kw_only: bool = False) -> Callable[[Kind], Kind]:
    """Decorate a subclass of `Immutable`, as `dataclass(frozen=True)` does; all subclasses need the same decorator."""
    make: Any = dataclass(init=False, repr=False, eq=False, kw_only=kw_only)

    def decorate(kind: type[Any]) -> Any:
        made = make(kind)
        made.__doc__ = FieldDocumentation(made.__doc__ or "")
        return made

    return cast("Callable[[Kind], Kind]", decorate)


class Immutable:
    """Base class of records: the methods of a frozen dataclass, for any fields. Defaults are values, no factories."""

    __signature__ = FieldSignature()

    def __init__(self, *values: Any, **named: Any) -> None:
        kind: Any = type(self)
        positional, defaults = parameters(kind)
        given = dict(zip(positional, values, strict=False)) | named
        complete = defaults | given
        if (
            len(given) < len(values) + len(named)
            or len(complete) > len(defaults)
            or any(value is MISSING for value in complete.values())
        ):
            kind.__signature__.bind(*values, **named)  # TypeError, which says what is wrong
        for name, value in complete.items():
            object.__setattr__(self, name, value)
        self.__post_init__()

    def __post_init__(self) -> None:
        """Check and complete the values; called once they are set."""

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        kind: Any = type(self)
        values = compared_values(kind)
        return bool(values(self) == values(other))

    def __hash__(self) -> int:
        kind: Any = type(self)
        return hash(compared_values(kind)(self))

    def __repr__(self) -> str:
        shown: Any = fields(self)  # type: ignore[arg-type]  # subclasses are dataclasses
        values = ", ".join(f"{each.name}={getattr(self, each.name)!r}" for each in shown if each.repr)
        return f"{type(self).__qualname__}({values})"


@cache
def parameters(kind: type[Any]) -> tuple[tuple[str, ...], dict[str, Any]]:
    """Return the fields that need no keyword, and the defaults of all fields, MISSING where there is none."""
    return tuple(each.name for each in fields(kind) if not each.kw_only), {
        each.name: each.default for each in fields(kind)
    }


@cache
def compared_values(kind: type[Any]) -> Callable[[object], Any]:
    """Return a function that returns the values by which records of a kind are compared."""
    return attrgetter(*(each.name for each in fields(kind) if each.compare), "__class__")
