"""File sync: no work is lost when another program writes the scene's file."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.mlx import Key
from minirt.scene import load
from minirt.viewer.app.file_sync import follow_change
from minirt.viewer.files import watched_file
from minirt.viewer.files.watched_file import Signature, WatchedFile, signature
from tests.viewer.fake import TEXT, colour_of, scene
from tests.viewer.session_harness import SessionHarness
from tests.waiting import HANG_LIMIT, until

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")
BROKEN = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -7")


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file


@pytest.fixture
def harness(path):
    harness = SessionHarness()
    harness.session.path, harness.session.file = path, WatchedFile(path)
    harness.finish(0.001)
    return harness


def write(path, text: str) -> None:
    """Replace the file, as many text editors do."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


def edit(harness) -> None:
    """Make an unsaved change: move the second element, a light."""
    harness.tap(Key.TAB)
    harness.tap(Key.D)


def notify(harness) -> None:
    """Tell the session that the file has changed, and finish the pictures that follow."""
    harness.session.notify_file_changed()
    harness.memory.play()
    while harness.painter.busy:
        harness.finish(0.001)


def test_a_changed_file_is_shown(harness, path):
    write(path, OTHER)
    notify(harness)
    assert harness.session.state.scene.spheres[0].diameter == 7
    assert (harness.session.picture == colour_of(harness.session.state.scene)).all()
    harness.tap(Key.CONTROL_L, Key.Z)
    assert harness.session.state.scene.spheres[0].diameter == 2


def test_the_camera_stays_unless_the_file_changes_it(harness, path):
    harness.tap(Key.D)
    moved = harness.session.state.scene.camera
    write(path, OTHER)
    notify(harness)
    assert harness.session.state.scene.camera == moved
    assert harness.session.state.home == scene().camera
    write(path, OTHER.replace("C 0,0,10", "C 0,0,20"))
    notify(harness)
    assert harness.session.state.scene.camera.position == (0, 0, 20)


def test_a_kept_camera_is_saved_in_its_own_line(harness, path):
    harness.tap(Key.D)
    write(path, OTHER.replace("# looks along -z", "# elsewhere"))
    notify(harness)
    harness.tap(Key.CONTROL_L, Key.S)
    assert "# elsewhere" in path.read_text()
    assert load(path).scene.camera.position[0] > 0


def test_a_broken_file_keeps_the_picture_and_shows_the_error_until_it_is_mended(harness, path):
    before = harness.session.state.scene
    write(path, BROKEN)
    notify(harness)
    assert harness.session.state.scene is before
    assert "5:10: sphere diameter must be > 0" in harness.session.screen.banner
    harness.tap(Key.TAB)
    assert harness.session.state.message == ""
    assert harness.session.screen.banner
    write(path, OTHER)
    notify(harness)
    assert harness.session.screen.banner == ""
    assert harness.session.state.scene.spheres[0].diameter == 7


class TestBothChanged:
    def test_the_file_is_not_read_and_a_banner_says_so(self, harness, path):
        edit(harness)
        edited = harness.session.state.scene
        write(path, OTHER)
        notify(harness)
        assert harness.session.state.scene is edited
        assert "Ctrl+R reads it" in harness.session.screen.banner

    def test_saving_keeps_a_copy_of_the_other_version(self, harness, path):
        edit(harness)
        write(path, OTHER)
        notify(harness)
        harness.tap(Key.CONTROL_L, Key.S)
        assert load(path).scene.items == harness.session.state.scene.items
        assert path.with_name("scene-1.rt").read_text() == OTHER
        assert harness.session.screen.banner == ""
        assert "scene-1.rt" in harness.session.state.message
        harness.tap(Key.D)
        harness.tap(Key.CONTROL_L, Key.S)
        assert not path.with_name("scene-2.rt").exists()

    def test_saving_keeps_a_copy_before_the_change_was_noticed(self, harness, path):
        edit(harness)
        write(path, BROKEN)
        harness.tap(Key.CONTROL_L, Key.S)
        assert path.with_name("scene-1.rt").read_text() == BROKEN

    def test_undo_after_reading_restores_the_edited_scene(self, harness, path):
        edit(harness)
        edited = harness.session.state.scene
        write(path, OTHER)
        notify(harness)
        harness.tap(Key.F5)
        assert harness.session.state.scene.spheres[0].diameter == 7
        harness.tap(Key.CONTROL_L, Key.Z)
        assert harness.session.state.scene is edited


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
        """Replace `minirt.viewer.files.watched_file.signature`: wait until the test allows a check."""
        if threading.current_thread().name == "minirt-watch":
            self._started += 1
            self._allowed.acquire(timeout=HANG_LIMIT)
        return signature(path)

    def close(self) -> None:
        self.file.close()
        self._allowed.release()

    def _notify(self) -> None:
        self.notified += 1


class TestWatchedFile:
    @pytest.fixture
    def watch(self, path, monkeypatch) -> Iterator[SteppedWatch]:
        monkeypatch.setattr(watched_file, "INTERVAL", 0.001)
        watch = SteppedWatch(path)
        monkeypatch.setattr(watched_file, "signature", watch.signature)
        watch.start()
        yield watch
        watch.close()

    def test_a_change_is_reported_once(self, path, watch):
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

    def test_writes_of_the_viewer_itself_are_not_reported(self, path, watch):
        path.write_text(OTHER)
        watch.file.accept(signature(path))
        watch.check(4)
        assert watch.notified == 0
        assert not watch.file.changed

    def test_a_change_is_reported_when_the_file_is_stable(self, path, monkeypatch):
        signatures = [(1, 1, 1), (2, 2, 1), (3, 3, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1)]
        seen: list[object] = []

        def next_signature(_path) -> object:
            seen.append(signatures[min(len(seen), len(signatures) - 1)])
            return seen[-1]

        monkeypatch.setattr(watched_file, "signature", next_signature)
        monkeypatch.setattr(watched_file, "INTERVAL", 0.001)
        watched = WatchedFile(path)
        notified: list[int] = []
        watched.watch(lambda: notified.append(len(seen)))
        until(lambda: len(seen) > len(signatures), "enough checks")
        watched.close()
        assert notified == [5]

    def test_a_deleted_file_is_not_reported(self, path, watch):
        path.unlink()
        watch.check(4)
        assert watch.notified == 0
        assert not watch.file.changed
        path.write_text(TEXT)
        watch.check(2)
        assert watch.notified == 1


class TestDrop:
    def test_another_file_is_opened(self, harness, path, tmp_path):
        other = tmp_path / "other one.rt"
        other.write_text(OTHER)
        harness.memory.drop(str(other))
        harness.memory.play()
        session = harness.session
        assert session.path == other
        assert session.window.title == "miniRT - other one.rt"
        assert session.state.scene.spheres[0].diameter == 7
        assert session.state.past == ()
        harness.tap(Key.TAB)
        harness.tap(Key.D)
        harness.tap(Key.CONTROL_L, Key.S)
        assert path.read_text() == TEXT
        assert other.read_text() != OTHER

    def test_unsaved_changes_are_kept_when_another_file_is_opened(self, harness, path, tmp_path):
        edit(harness)
        edited = harness.session.state.scene
        other = tmp_path / "other.rt"
        other.write_text(OTHER)
        harness.memory.drop(str(other))
        harness.memory.play()
        kept = path.with_name("scene.recovered.rt")
        assert load(kept).scene.items == edited.items
        assert str(kept) in harness.session.state.message

    @pytest.mark.parametrize(("name", "text"), [("broken.rt", BROKEN), ("picture.png", "x"), ("none.rt", None)])
    def test_a_file_that_is_no_scene_gives_a_message(self, harness, path, tmp_path, name, text):
        if text:
            (tmp_path / name).write_text(text)
        before = harness.session.state.scene
        harness.memory.drop(str(tmp_path / name))
        harness.memory.play()
        assert harness.session.state.scene is before
        assert harness.session.path == path
        assert name in harness.session.state.message


def test_a_change_is_followed_without_the_watching_thread(harness, path):
    write(path, OTHER)
    follow_change(harness.session)
    assert harness.session.state.scene.spheres[0].diameter == 7
