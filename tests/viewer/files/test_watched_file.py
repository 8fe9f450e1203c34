"""File watching: changes by other programs are reported once, as soon as the file is stable."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.viewer import files
from minirt.viewer.files import Signature, WatchedFile, signature
from tests.viewer.fake import TEXT
from tests.waiting import HANG_LIMIT, until

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file


def write(path, text: str) -> None:
    """Replace the file, as many text editors do."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


class SteppedWatch:
    """A watched file whose thread checks it only when the test says so."""

    def __init__(self, path: Path) -> None:
        self.notified = 0  # how often a change was reported
        self.file = WatchedFile(path)
        self._allowed = threading.Semaphore(0)
        self._checks = 0
        self._started = 0

    def start(self) -> None:
        self.file.watch(self._notify)

    def check(self, times: int = 1) -> None:
        """Allow so many checks of the file; return when the thread begins the next one and has reported any change."""
        self._checks += times
        self._allowed.release(times)
        until(lambda: self._started == self._checks + 1, "a check of the file")

    def signature(self, path: Path) -> Signature:
        """Replace `minirt.viewer.files.signature`: wait until the test allows a check."""
        if threading.current_thread().name == "minirt-watch":
            self._started += 1
            self._allowed.acquire(timeout=HANG_LIMIT)
        return signature(path)

    def close(self) -> None:
        self.file.close()
        self._allowed.release()

    def _notify(self) -> None:
        self.notified += 1


@pytest.fixture
def watch(path, monkeypatch) -> Iterator[SteppedWatch]:
    monkeypatch.setattr(files, "INTERVAL", 0.001)
    watch = SteppedWatch(path)
    monkeypatch.setattr(files, "signature", watch.signature)
    watch.start()
    yield watch
    watch.close()


def test_a_change_is_reported_once(path, watch):
    watch.check(4)
    assert watch.notified == 0
    write(path, OTHER)
    watch.check()
    assert watch.notified == 0  # it may still be written
    watch.check()
    assert watch.notified == 1
    watch.check(4)
    assert watch.notified == 1
    assert watch.file.changed


def test_writes_of_the_viewer_itself_are_not_reported(path, watch):
    path.write_text(OTHER)
    watch.file.accept(signature(path))
    watch.check(4)
    assert watch.notified == 0
    assert not watch.file.changed


def test_a_change_is_reported_when_the_file_is_stable(path, monkeypatch):
    signatures = [(1, 1, 1), (2, 2, 1), (3, 3, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1)]
    seen: list[object] = []

    def next_signature(_path) -> object:
        seen.append(signatures[min(len(seen), len(signatures) - 1)])
        return seen[-1]

    monkeypatch.setattr(files, "signature", next_signature)
    monkeypatch.setattr(files, "INTERVAL", 0.001)
    watched = WatchedFile(path)
    notified: list[int] = []
    watched.watch(lambda: notified.append(len(seen)))
    until(lambda: len(seen) > len(signatures), "enough checks")
    watched.close()
    assert notified == [5]


def test_a_deleted_file_is_reported_once_and_again_when_it_is_back(path, watch):
    assert not watch.file.missing
    path.unlink()
    watch.check(4)
    assert watch.notified == 1
    assert watch.file.missing
    assert not watch.file.changed
    path.write_text(TEXT)
    watch.check(2)
    assert watch.notified == 2
    assert not watch.file.missing


def test_a_file_that_never_was_there_is_not_missing(tmp_path):
    assert not WatchedFile(tmp_path / "none.rt").missing
