"""Log of the errors and notices that a reader of a scene file finds."""

from __future__ import annotations

from pathlib import Path

from minirt.errors import Problem
from minirt.scene.lines import Line

MAX_ERRORS = 1000  # in one file; a file with more is not a scene
MAX_NOTICES = 1000


class Log:
    """The errors and notices of one scene file."""

    def __init__(self, file: str, lenient: bool, folder: Path | None = None) -> None:
        """Make an empty log of a file. The scene's file names are relative to `folder`, by default that of the file;
        without either, as for `file` '', named files are not opened."""
        self.file = file
        self.folder = Path(file).parent if file and not folder else folder
        self.lenient = lenient
        self.errors: list[Problem] = []
        self.notices: list[Problem] = []

    @property
    def full(self) -> bool:
        """Whether there are so many errors that reading stops."""
        return len(self.errors) >= MAX_ERRORS

    def error(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Add an error; a file with errors is refused."""
        self.errors.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def notice(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Add a notice about a file that is accepted. The last of too many says that there are more."""
        if len(self.notices) == MAX_NOTICES:
            message = "too many notices: those from here on are left out"
        if len(self.notices) <= MAX_NOTICES:
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
