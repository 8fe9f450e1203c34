"""Log of the errors and notices that a reader of a scene file finds."""

from __future__ import annotations

from pathlib import Path

from minirt.errors import Problem
from minirt.scene.lines import Line

MAX_ERRORS = 1000  # in one file; a file with more is not a scene


class Log:
    """The errors and notices of one scene file."""

    def __init__(self, file: str, lenient: bool) -> None:
        self.file = file
        self.lenient = lenient
        self.errors: list[Problem] = []
        self.notices: list[Problem] = []

    @property
    def folder(self) -> Path | None:
        """Folder to which the scene's file names are relative; None without a file: then named files are not opened."""
        return Path(self.file).parent if self.file else None

    @property
    def full(self) -> bool:
        """Whether there are so many errors that reading stops."""
        return len(self.errors) >= MAX_ERRORS

    def error(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Add an error; a file with errors is refused."""
        self.errors.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def notice(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Add a notice about a file that is accepted."""
        self.notices.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def tolerate(
        self, line: Line, column: int, message: str, remedy: str, certain: bool = False, length: int = 1
    ) -> bool:
        """Add a notice if the reader is lenient, an error if it is strict; return whether it is lenient.

        `remedy` says what a lenient reader does: "rounds it to 10,0,255". A `certain` one is that of every reader.
        """
        if certain:
            self.notice(line, column, f"{message} (miniRT {remedy})", length)
            return True
        add = self.notice if self.lenient else self.error
        add(line, column, f"{message} (--lenient {remedy})", length)
        return self.lenient
