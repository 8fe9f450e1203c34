"""Journal of a session: a thread writes each unsaved change to disk, at most a quarter of a second after it.

So a killed program loses nothing but its last moments. The journal is deleted when nothing is unsaved.
"""

from __future__ import annotations

import logging
import os
import threading
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.scene import Scene, dump, files
from minirt.viewer.files import Signature, contents_differ, signature
from minirt.viewer.recovery import journal_file
from minirt.viewer.recovery.journal_folder import create_journal
from minirt.viewer.recovery.splice import difference

INTERVAL = 0.25  # seconds between two writes
MOST_CHANGES = 2**24  # bytes that a journal grows by before a new one takes its place


class Version(NamedTuple):
    """A version of the scene, and the version that its file holds."""

    scene: Scene
    saved: Scene
    file: Path
    signature: Signature  # of the file with `saved`


class Journal:
    """Keeps the newest version of a session's scene on disk. The thread starts with the first change."""

    def __init__(self) -> None:
        self.path: Path | None = None  # of the journal, while there is one
        self._file: BinaryIO | None = None
        self._size = self._most = 0  # bytes of the journal, and how many it may have before a new one begins
        self._newest: Version | None = None
        self._written: Version | None = None
        self._obsolete: list[Path] = []  # journals to delete as soon as this one holds their changes
        self._told = False  # that the disk is full, or the like
        self._changed = threading.Event()
        self._closed = threading.Event()
        self._writing = threading.Lock()
        self._thread: threading.Thread | None = None

    def keep(self, version: Version) -> None:
        """Keep a version, soon; the last one that was given is the one that counts."""
        newest = self._newest
        if newest and newest.scene is version.scene and newest.saved is version.saved:
            return
        self._newest = version
        if self._thread is None and version.scene is not version.saved:
            self._thread = threading.Thread(target=self._run, name="minirt-journal", daemon=True)
            self._thread.start()
        self._changed.set()

    def replace(self, path: Path) -> None:
        """Delete another journal, of a killed program, as soon as this one holds its changes."""
        self._obsolete.append(path)

    def flush(self) -> None:
        """Write the newest version now. Where that fails, a notice says so and the next change tries again."""
        with self._writing:
            try:
                if self._newest and self._newest is not self._written:
                    self._write(self._newest)
            except (OSError, RuntimeError) as error:  # RuntimeError: the user has no home
                if not self._told:
                    logging.getLogger(__name__).warning("notice: unsaved changes cannot be kept on disk: %s", error)
                self._told = True
                self._abandon_file()

    def close(self, *, delete: bool) -> None:
        """Stop; `delete`: nothing in the journal is needed any more."""
        self._closed.set()
        self._changed.set()
        if self._thread:
            self._thread.join()
        with self._writing:
            self._end_file(delete=delete)

    def _run(self) -> None:
        while not self._closed.is_set():
            self._changed.wait()
            self._changed.clear()
            self.flush()
            self._closed.wait(INTERVAL)

    def _write(self, version: Version) -> None:
        """Bring the journal up to date with a version. OSError, RuntimeError."""
        before = self._written
        if before and (before.saved is not version.saved or not contents_differ(version.scene, version.saved)):
            self._end_file(delete=True)
        if contents_differ(version.scene, version.saved):
            if self._size > self._most:
                self._end_file(delete=False)
            is_new = not self._file
            if is_new:
                self.path, self._file = create_journal(version.file)
                self._append(journal_file.beginning(version.file, text_of(version)))
            splice = difference(self._written.scene if self._written else version.saved, version.scene)
            if splice:
                self._append(journal_file.record(splice))
            if is_new:
                self._most = self._size + MOST_CHANGES
            self._delete_obsolete()
        self._written = version

    def _append(self, data: bytes) -> None:
        assert self._file
        self._size += len(data)
        while data:
            data = data[self._file.write(data) :]
        os.fsync(self._file.fileno())

    def _end_file(self, *, delete: bool) -> None:
        """Close the journal and delete it, or else delete it when a new one holds its changes."""
        if self._file and self.path:
            self._file.close()
            self._obsolete.append(self.path)
        self._file = self.path = self._written = None
        self._size = self._most = 0
        if delete:
            self._delete_obsolete()

    def _abandon_file(self) -> None:
        """Close a journal that cannot be written, and delete it unless it holds some version."""
        holds_nothing, path = self._written is None, self.path
        self._end_file(delete=False)
        if holds_nothing and path:
            self._obsolete.remove(path)
            with suppress(OSError):
                path.unlink()

    def _delete_obsolete(self) -> None:
        """Delete the journals that are not needed any more."""
        while self._obsolete:
            with suppress(OSError):
                self._obsolete.pop().unlink()


def text_of(version: Version) -> bytes:
    """Return the text of the saved scene: that of its file, or written anew where another program changed the file."""
    with suppress(OSError, FileError):
        data = file_io.read(version.file, files.MAX_BYTES)
        is_its_file = version.saved.file == version.file and signature(version.file) == version.signature
        if is_its_file and data.count(b"\n") + 1 == len(version.saved.items):
            return data
    return dump(version.saved).encode()
