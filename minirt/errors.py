"""The errors that miniRT raises, as a tree.

    MiniRTError
    ├── SceneError     a scene file cannot be read, used or written: every problem found in it
    ├── RenderError    a picture cannot be made or written
    ├── ReplayError    a file of recorded keys cannot be played
    └── MlxError       no window can be opened

    ValueError
    ├── FieldError     a value that a field of a scene element cannot take; the parser makes a Problem of it
    └── ElementError   fields of a scene element that do not go together

Only `minirt.cli` prints them.
"""

from __future__ import annotations

from dataclasses import dataclass


class MiniRTError(Exception):
    """Root of all errors that miniRT raises on purpose."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong, or was tolerated, in a text file."""

    file: str
    line: int  # from 1; 0 where the whole file is meant
    column: int  # from 1, in characters
    text: str  # the line as it stands in the file
    message: str  # what was expected, and what was found
    length: int = 1  # characters to underline

    def __str__(self) -> str:
        file = printable(self.file)
        if not self.line:
            return f"{file}: {self.message}"
        where = f"{file}:{self.line}:{self.column}: {self.message}"
        return where + "\n" + excerpt(self.text, self.column, self.length)


def printable(text: str) -> str:
    """`text` with a blank in the place of every character that would act on a terminal."""
    return "".join(character if character.isprintable() else " " for character in text)


def quoted(text: str, width: int = 40) -> str:
    """`text` between quotes for a message: control characters escaped, and cut to `width` characters."""
    return repr(text if len(text) <= width else text[: width - 1] + "…")


def excerpt(text: str, column: int, length: int, width: int = 100) -> str:
    """The line around `column` with a caret under it, cut to `width` characters where it is longer."""
    start = max(0, column - 1 - width // 2) if len(text) > width else 0
    shown = printable(text[start : start + width])
    caret = " " * (column - 1 - start) + "^" + "~" * (min(length, width - (column - 1 - start)) - 1)
    return f"    {shown}\n    {caret}".rstrip()


class SceneError(MiniRTError):
    """A scene file that cannot be read, used or written; `problems` are in the order of its lines."""

    def __init__(self, problems: tuple[Problem, ...]) -> None:
        self.problems = problems
        super().__init__("\n".join(map(str, problems)))


class RenderError(MiniRTError):
    """A picture that cannot be made or written."""


class ReplayError(MiniRTError):
    """A file of recorded keys that cannot be played."""


class MlxError(MiniRTError):
    """No window can be opened, or a window call was wrong."""


class FieldError(ValueError):
    """A value that a field cannot take; `part` is the component that is to blame, from 0, or None for all of it."""

    def __init__(self, message: str, part: int | None = None) -> None:
        super().__init__(message)
        self.part = part


class ElementError(ValueError):
    """Fields of an element that do not go together."""
