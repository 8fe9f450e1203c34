"""Recovery of unsaved changes: a thread writes the scene's text to the user's state folder within a second of a change.

So a killed program loses no more than its last second. The file is deleted when nothing is unsaved; one that a killed
program left is offered when the scene is opened again. An empty file beside the folder tells that the panel is open.
"""

from __future__ import annotations

import glob
import hashlib
import logging
import os
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from minirt.errors import FileError, SceneError
from minirt.helpers import file_io
from minirt.scene import Scene, dump, files
from minirt.viewer.files import contents_differ

INTERVAL = 0.8  # seconds between two writes, which leaves a fifth of a second for the write itself
PANEL_MARK = "panel-is-open"  # the empty file
KEPT = 30 * 24 * 3600  # seconds that changes are kept which are older than their scene


class Version(NamedTuple):
    """A version of the scene, and the version that its file holds."""

    scene: Scene
    saved: Scene
    file: Path


class Recovery:
    """Keeps the text of a session's scene on disk while it has unsaved changes. The thread starts with the first."""

    def __init__(self) -> None:
        self.path: Path | None = None  # of the file, while there is one
        self._lock = -1  # descriptor of the file beside it, which is locked while this program runs
        self._newest: Version | None = None
        self._written: Version | None = None
        self._told = False  # that the disk is full, or the like
        self._timer: threading.Timer | None = None  # of the next write
        self._writing = threading.Lock()

    def keep(self, version: Version) -> None:
        """Keep a version, soon; the last one that was given is the one that counts."""
        newest, self._newest = self._newest or version._replace(scene=version.saved), version
        if self._timer is None and (newest.scene is not version.scene or newest.saved is not version.saved):
            self._timer = threading.Timer(INTERVAL, self.flush)
            self._timer.daemon = True
            self._timer.start()

    def adopt(self, path: Path) -> None:
        """Go on with the file of a killed program, whose changes the session has taken."""
        with suppress(OSError), self._writing:  # OSError: another program has adopted it just now
            lock = open_lock(path)
            self._delete()
            self.path, self._lock = path, lock

    def flush(self) -> None:
        """Write the newest version now. Where that fails, a notice says so and the next change tries again."""
        with self._writing:
            self._timer = None
            try:
                if self._newest and self._newest is not self._written:
                    self._write(self._newest)
            except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
                if not self._told:
                    logging.getLogger(__name__).warning("notice: unsaved changes cannot be kept on disk: %s", error)
                self._told = True

    def close(self, *, delete: bool) -> None:
        """Stop, and `delete` the file, as nothing in it is needed any more, or else write the last change to it."""
        timer = self._timer
        if timer:
            timer.cancel()
        if not delete:
            self.flush()
        with self._writing:
            self._newest = None
            if delete:
                self._delete()
            elif self.path:
                file_io.unlock(self._lock)
                self.path = None

    def _write(self, version: Version) -> None:
        """Bring the file up to date with a version, or delete it if the version has no unsaved changes. For another
        scene file than before, it is a new file. OSError, RuntimeError."""
        unsaved = contents_differ(version.scene, version.saved)
        if not unsaved or (self._written and self._written.file != version.file):
            self._delete()
        if unsaved:
            if self.path is None:
                folder = state_folder()
                folder.mkdir(mode=file_io.PRIVATE_FOLDER, parents=True, exist_ok=True)
                path = folder / f"{name_of(version.file)}-{os.urandom(6).hex()}.rt"
                self.path, self._lock = path, open_lock(path)
            file_io.write(self.path, dump(version.scene).encode(), file_io.PRIVATE_FILE)
            with suppress(OSError):  # the scene file is never newer than its changes, even if a clock was set back
                file, kept = version.file.stat(), self.path.stat()
                os.utime(self.path, ns=(kept.st_atime_ns, max(file.st_mtime_ns, kept.st_mtime_ns)))
        self._written = version

    def _delete(self) -> None:
        if self.path:
            file_io.unlock(self._lock)
            file_io.delete(self.path, self.path.with_suffix(".lock"))
        self.path = None


class FoundChanges(NamedTuple):
    """Unsaved changes of a scene: a file of `Recovery`, or one that Escape left beside the scene."""

    path: Path
    time: float  # of the last change, in seconds since 1970
    text: str  # of the scene with the changes
    beside: bool  # whether the file is beside the scene

    @property
    def title(self) -> str:
        """Their name in messages: time of day, with the date unless it is today."""
        when = datetime.fromtimestamp(self.time)  # in the user's own time
        date = "" if when.date() == datetime.now().date() else f"{when:%Y-%m-%d} "
        return f"unsaved changes of {date}{when:%H:%M}{f' ({self.path.name})' if self.beside else ''}"


def find_changes(file: Path) -> FoundChanges | None:
    """Return the last unsaved changes of a scene file that differ from it and are newer, if it is there."""
    found = []
    with suppress(OSError, FileError, UnicodeDecodeError):
        text, saved = "", 0.0
        if not file_io.is_absent(file):
            text, saved = file_io.read(file, files.MAX_BYTES).decode(), file.stat().st_mtime
        beside = sorted(file.parent.glob(f"{glob.escape(file.stem)}.recovered*.rt"))
        for path in [*abandoned(file, saved), *beside]:
            with suppress(OSError, SceneError, UnicodeDecodeError):
                found.append(FoundChanges(path, path.stat().st_mtime, files.read(path).decode(), path in beside))
        found = [each for each in found if each.time >= saved and each.text != text]
    return max(found, key=lambda each: each.time, default=None)


def state_folder() -> Path:
    """Return the folder of this user's unsaved changes; RuntimeError where the user has no home."""
    return file_io.user_folder("XDG_STATE_HOME", "Application Support", ".local/state") / "minirt" / "unsaved"


def remember_panel(*, is_open: bool) -> None:
    """Remember for the next window whether the panel is open, by an empty file."""
    with suppress(OSError, RuntimeError):
        mark = state_folder().with_name(PANEL_MARK)
        mark.parent.mkdir(mode=file_io.PRIVATE_FOLDER, parents=True, exist_ok=True)
        mark.touch(file_io.PRIVATE_FILE) if is_open else mark.unlink(missing_ok=True)


def panel_was_open() -> bool:
    """Whether the panel was open when a window was last closed."""
    with suppress(OSError, RuntimeError):  # the user has no home
        return state_folder().with_name(PANEL_MARK).exists()
    return False


def name_of(file: Path) -> str:
    """Return how the names of the files with unsaved changes of a scene file begin."""
    return hashlib.sha256(os.fsencode(os.path.realpath(file))).hexdigest()[:24]


def open_lock(path: Path) -> int:
    """Open and, if no running program has, lock the file that is locked while a program writes `path`. OSError."""
    descriptor = os.open(path.with_suffix(".lock"), os.O_RDWR | os.O_CREAT, file_io.PRIVATE_FILE)
    if not file_io.lock(descriptor):
        file_io.unlock(descriptor)
        raise BlockingIOError
    return descriptor


def abandoned(file: Path, saved: float) -> Iterator[Path]:
    """Yield the files with unsaved changes of a scene file that no running program writes; delete very old ones."""
    with suppress(OSError, RuntimeError):
        for lock in sorted(state_folder().glob(f"{name_of(file)}-*.lock")):
            path = lock.with_suffix(".rt")
            with suppress(OSError):
                file_io.unlock(open_lock(path))
                if not path.exists() or path.stat().st_mtime >= min(saved, time.time() - KEPT):
                    yield path
                else:
                    file_io.delete(path, lock)
