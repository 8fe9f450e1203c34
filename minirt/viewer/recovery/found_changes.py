"""Search for unsaved changes of a scene file, which an earlier run of the program could not save."""

from __future__ import annotations

import glob
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from minirt.errors import FileError, SceneError
from minirt.helpers import file_io
from minirt.scene import files
from minirt.viewer.recovery import journal_file
from minirt.viewer.recovery.journal_folder import abandoned_journals


class FoundChanges(NamedTuple):
    """Unsaved changes of a scene: a journal, or a recovery file beside the scene."""

    path: Path
    time: float  # of the last change, in seconds since 1970
    text: str  # of the scene with the changes
    is_journal: bool
    base: str | None = None  # text of the scene before the changes, where it is known

    @property
    def title(self) -> str:
        """Their name in messages: time of day, with the date unless it is today."""
        try:
            when = datetime.fromtimestamp(self.time)  # in the user's own time
        except (OSError, OverflowError, ValueError):  # beyond the year 9999, which some file systems hold
            return f"unsaved changes ({self.path.name})"
        date = "" if when.date() == datetime.now().date() else f"{when:%Y-%m-%d} "
        name = "" if self.is_journal else f" ({self.path.name})"
        return f"unsaved changes of {date}{when:%H:%M}{name}"


def find_changes(file: Path) -> FoundChanges | None:
    """Return the last unsaved changes of a scene file that are newer than the file and differ from it.

    Changes of just the text that the file has are newer, whatever the times say: clocks are set back, too.
    """
    with suppress(OSError, FileError, SceneError, UnicodeDecodeError):
        now, saved = file_io.read(file, files.MAX_BYTES).decode(), file.stat().st_mtime
        newest = sorted(candidates(file), key=lambda each: each.time)
        return next((each for each in reversed(newest) if is_newer(each, now, saved) and each.text != now), None)
    return None


def is_newer(changes: FoundChanges, now: str, saved: float) -> bool:
    """Whether changes were made after the file got its text `now`, at the time `saved`."""
    return changes.base == now or changes.time >= saved


def candidates(file: Path) -> Iterator[FoundChanges]:
    """Yield all journals and recovery files of a scene file that can be read."""
    for path in abandoned_journals(file):
        with suppress(OSError, FileError, ValueError):
            contents = journal_file.read(path)
            yield FoundChanges(path, path.stat().st_mtime, contents.text, is_journal=True, base=contents.base)
    for path in sorted(file.parent.glob(f"{glob.escape(file.stem)}.recovered*.rt")):
        with suppress(OSError, SceneError, UnicodeDecodeError):
            yield FoundChanges(path, path.stat().st_mtime, files.read(path).decode(), is_journal=False)
