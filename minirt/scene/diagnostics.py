"""What a reader of a scene file has to say about it."""

from __future__ import annotations

from pathlib import Path

from minirt.errors import Problem
from minirt.scene.lines import Line

MAX_ERRORS = 1000  # of one file; a file with more is something else than a scene


class Log:
    """The errors and the notices of one file."""

    def __init__(self, file: str, lenient: bool) -> None:
        self.file = file
        self.lenient = lenient
        self.errors: list[Problem] = []
        self.notices: list[Problem] = []

    @property
    def folder(self) -> Path | None:
        """Where the ways to the files begin that the scene names; None for lines of no file, for which nobody looks."""
        return Path(self.file).parent if self.file else None

    @property
    def full(self) -> bool:
        """Whether it is useless to read on."""
        return len(self.errors) >= MAX_ERRORS

    def error(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Something that makes the file useless."""
        self.errors.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def notice(self, line: Line, column: int, message: str, length: int = 1) -> None:
        """Something that the user should know of a file that is read."""
        self.notices.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def tolerate(self, line: Line, column: int, message: str, deed: str, length: int = 1) -> bool:
        """Something that a lenient reader takes by its `deed`, and a strict one refuses; whether it is taken."""
        tell = self.notice if self.lenient else self.error
        tell(line, column, f"{message} (--lenient {deed})", length)
        return self.lenient
