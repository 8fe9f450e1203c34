"""Exceptions of miniRT.

    MiniRTError
    ├── SceneError     a scene file cannot be read, used or written: all of its problems
    ├── RenderError    a picture cannot be rendered or written
    ├── FileError      a file that a scene names, such as a texture or a mesh, cannot be used
    ├── ElementError   fields of a scene element that are out of range or do not go together; a ValueError, too
    ├── ReplayError    a file of recorded keys cannot be played
    └── MlxError       no window can be opened

    ValueError
    └── FieldError     a value that a field of a scene element cannot take; the parser makes a Problem of it

Only `minirt.cli` prints them.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import inf
from operator import index
from typing import Any


class MiniRTError(Exception):
    """Base class of the errors that miniRT raises on purpose."""


@dataclass(frozen=True, slots=True)
class Problem:
    """An error, or a tolerated mistake, in a text file."""

    file: str
    line: int  # from 1; 0 for the whole file
    column: int  # from 1, in characters
    text: str  # the line as it stands in the file
    message: str  # what was expected, and what was found
    length: int = 1  # characters to underline
    hint: str = ""  # the line that may be meant, '' where that is unknown

    def __str__(self) -> str:
        file = printable(self.file)
        if not self.line:
            return f"{file}: {self.message}"
        location = f"{file}:{self.line}:{self.column}: {self.message}"
        return location + "\n" + excerpt(self.text, self.column, self.length) if self.text else location


def printable(text: str) -> str:
    """Replace every unprintable character, which could act on a terminal, by a blank."""
    return "".join(character if character.isprintable() else " " for character in text)


def quoted(text: str, width: int = 40) -> str:
    """Quote a text for a message: control characters escaped, cut to `width` characters."""
    return repr(text if len(text) <= width else text[: width - 1] + "…")


def counted(count: int, what: str) -> str:
    """Return a number of things: `1 camera`, `2 cameras`."""
    return f"{count} {what}{'s' * (count != 1)}"


def nearest(word: str, known: Iterable[str], cutoff: float = 0.6, count: int = 1) -> list[str]:
    """Return the known words whose spelling is most like a word's, the most similar first, `count` at most."""
    from difflib import get_close_matches

    return get_close_matches(word[:40], list(known), count, cutoff)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return `, did you mean 'Tab'?` for a similar known word, or an empty string."""
    return hint("".join(nearest(word, known)))


def hint(word: str) -> str:
    """Return `, did you mean 'Tab'?`, or an empty string without a word."""
    return f", did you mean '{word}'?" if word else ""


def excerpt(text: str, column: int, length: int, width: int = 100) -> str:
    """Return a line with a caret under `column`; of a long line `width` characters around it."""
    start = max(0, column - 1 - width // 2) if len(text) > width else 0
    shown = printable(text[start : start + width])
    caret = " " * (column - 1 - start) + "^" + "~" * (min(length, width - (column - 1 - start)) - 1)
    return f"    {shown}\n    {caret}".rstrip()


class SceneError(MiniRTError):
    """A scene file cannot be read, used or written; `problems` are in the order of its lines."""

    def __init__(self, problems: tuple[Problem, ...]) -> None:
        self.problems = problems
        super().__init__("\n".join(map(str, problems)))

    def __reduce__(self) -> tuple[object, ...]:  # pickle would call the class with the message
        return type(self), (self.problems,)


class RenderError(MiniRTError):
    """A picture cannot be rendered or written."""


def check_whole(name: str, value: Any, least: int, most: float = inf) -> int:
    """Return the value of an argument if it is a whole number, numpy's included, of at least `least` and at most
    `most`; RenderError, which names the argument, for any other."""
    if isinstance(value, bool) or not hasattr(value, "__index__") or not least <= index(value) <= most:
        limits = f"of at least {least}" if most == inf else f"from {least} to {most}"
        raise RenderError(f"{name} must be a whole number {limits}, got {value!r}")
    return index(value)


class FileError(MiniRTError):
    """A file cannot be used; `reason` is the message without the file's name."""

    def __init__(self, path: str | os.PathLike[str], reason: str) -> None:
        self.path = os.fspath(path)
        self.reason = reason
        super().__init__(f"{printable(self.path)}: {reason}")

    def __reduce__(self) -> tuple[object, ...]:  # pickle would call the class with the message alone
        return type(self), (self.path, self.reason)


class ReplayError(MiniRTError):
    """A file of recorded keys cannot be played."""


class MlxError(MiniRTError):
    """No window can be opened, or a window function was called wrongly."""


class FieldError(ValueError):
    """A value that a field cannot take; `part` is the number of the wrong component, from 0, None for all of it."""

    further: Sequence[FieldError] = ()  # errors about its other components

    def __init__(self, message: str, part: int | None = None) -> None:
        super().__init__(message)
        self.part = part


class ElementError(MiniRTError, ValueError):
    """Fields of a scene element, or of a record, that are out of range or do not go together."""
