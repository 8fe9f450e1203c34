"""The scene's file on the disk, where other programs change it, too."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

INTERVAL = 0.25  # seconds from look to look

Signature = tuple[int, int, int] | None  # time of change, size, number of the file; None where there is none


class WatchedFile:
    """Knows the file as it was last read or written here, and tells of changes by others when asked to watch it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known = signature(path)
        self._told = self._known
        self._over = threading.Event()

    def accept(self, seen: Signature) -> None:
        """The file with that signature is known."""
        self._known = self._told = seen

    @property
    def changed(self) -> bool:
        """Whether somebody else wrote the file since."""
        now = signature(self.path)
        return now is not None and now != self._known

    def watch(self, tell: Callable[[], object]) -> None:
        """From now on call `tell`, from another thread, when the file has become another and stays so for a moment."""
        threading.Thread(target=self._watch, args=(tell,), name="minirt-watch", daemon=True).start()

    def close(self) -> None:
        """Watch no more."""
        self._over.set()

    def _watch(self, tell: Callable[[], object]) -> None:
        before = self._told
        while not self._over.wait(INTERVAL):
            now = signature(self.path)
            if now == before and now not in (None, self._told):
                self._told = now
                tell()
            before = now


def signature(path: Path) -> Signature:
    """What changes with a file."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
