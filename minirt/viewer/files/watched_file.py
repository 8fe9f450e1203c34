"""File watching: notice when another program changes the scene's file."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

INTERVAL = 0.25  # seconds between two checks of the file

Signature = tuple[int, int, int] | None  # modification time, size, inode; None if there is no file


class WatchedFile:
    """A file whose last state read or written here is known, so that changes by other programs can be reported."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known = signature(path)
        self._reported = self._known
        self._closed = threading.Event()

    def accept(self, seen: Signature) -> None:
        """Record the signature of the file as it was just read or written here."""
        self._known = self._reported = seen

    @property
    def known(self) -> Signature:
        """The signature of the file as it was last read or written here."""
        return self._known

    @property
    def missing(self) -> bool:
        """Whether the file was there, and is not any more."""
        return self._known is not None and signature(self.path) is None

    @property
    def changed(self) -> bool:
        """Whether another program has written the file since."""
        now = signature(self.path)
        return now is not None and now != self._known

    def watch(self, notify: Callable[[], object]) -> None:
        """Start a thread that calls `notify` when the file was changed or deleted and two checks found it the same."""
        threading.Thread(target=self._watch, args=(notify,), name="minirt-watch", daemon=True).start()

    def close(self) -> None:
        """Stop watching."""
        self._closed.set()

    def _watch(self, notify: Callable[[], object]) -> None:
        before = self._reported
        while not self._closed.wait(INTERVAL):
            now = signature(self.path)
            if now == before and now != self._reported:
                self._reported = now
                notify()
            before = now


def signature(path: Path) -> Signature:
    """Return the numbers that differ when a file has changed."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
