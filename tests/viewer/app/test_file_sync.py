"""The file and its window, while another program writes the file: nobody's work is lost."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.mlx import Key
from minirt.scene import load
from minirt.viewer.app.file_sync import file_changed
from minirt.viewer.files import watched_file
from minirt.viewer.files.watched_file import Signature, WatchedFile, signature
from tests.viewer.app.test_session import Bench
from tests.viewer.fake import TEXT, colour_of, scene
from tests.waiting import HANG_LIMIT, until

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")
BROKEN = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -7")


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file


@pytest.fixture
def bench(path):
    made = Bench()
    made.session.path, made.session.disk = path, WatchedFile(path)
    made.finish(0.001)
    return made


def write(path, text: str) -> None:
    """As an editor does that puts another file in its place."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


def edit(bench) -> None:
    """Something that would be lost: the second element, a light, moves."""
    bench.tap(Key.TAB)
    bench.tap(Key.D)


def tell(bench) -> None:
    bench.session.tell()
    bench.memory.play()
    while bench.painter.busy:
        bench.finish(0.001)


def test_what_was_written_is_shown(bench, path):
    write(path, OTHER)
    tell(bench)
    assert bench.session.state.scene.spheres[0].diameter == 7
    assert (bench.session.picture == colour_of(bench.session.state.scene)).all()
    bench.tap(Key.CONTROL_L, Key.Z)
    assert bench.session.state.scene.spheres[0].diameter == 2


def test_the_way_one_looks_stays_unless_the_file_says_another(bench, path):
    bench.tap(Key.D)
    moved = bench.session.state.scene.camera
    write(path, OTHER)
    tell(bench)
    assert bench.session.state.scene.camera == moved
    assert bench.session.state.file_camera == scene().camera
    write(path, OTHER.replace("C 0,0,10", "C 0,0,20"))
    tell(bench)
    assert bench.session.state.scene.camera.position == (0, 0, 20)


def test_the_camera_is_then_saved_in_its_own_line(bench, path):
    bench.tap(Key.D)
    write(path, OTHER.replace("# looks along -z", "# elsewhere"))
    tell(bench)
    bench.tap(Key.CONTROL_L, Key.S)
    assert "# elsewhere" in path.read_text()
    assert load(path).scene.camera.position[0] > 0


def test_a_broken_file_keeps_the_picture_and_says_why_until_it_is_whole(bench, path):
    before = bench.session.state.scene
    write(path, BROKEN)
    tell(bench)
    assert bench.session.state.scene is before
    assert "5:10: sphere diameter must be > 0" in bench.session.screen.banner
    bench.tap(Key.TAB)
    assert bench.session.state.message == ""
    assert bench.session.screen.banner
    write(path, OTHER)
    tell(bench)
    assert bench.session.screen.banner == ""
    assert bench.session.state.scene.spheres[0].diameter == 7


class TestBothChanged:
    def test_nothing_is_read_and_a_banner_says_so(self, bench, path):
        edit(bench)
        mine = bench.session.state.scene
        write(path, OTHER)
        tell(bench)
        assert bench.session.state.scene is mine
        assert "Ctrl+R reads it" in bench.session.screen.banner

    def test_saving_keeps_the_other(self, bench, path):
        edit(bench)
        write(path, OTHER)
        tell(bench)
        bench.tap(Key.CONTROL_L, Key.S)
        assert load(path).scene.items == bench.session.state.scene.items
        assert path.with_name("scene-1.rt").read_text() == OTHER
        assert bench.session.screen.banner == ""
        assert "scene-1.rt" in bench.session.state.message
        bench.tap(Key.D)
        bench.tap(Key.CONTROL_L, Key.S)
        assert not path.with_name("scene-2.rt").exists()

    def test_also_where_nobody_told(self, bench, path):
        edit(bench)
        write(path, BROKEN)
        bench.tap(Key.CONTROL_L, Key.S)
        assert path.with_name("scene-1.rt").read_text() == BROKEN

    def test_reading_keeps_mine_in_the_undo(self, bench, path):
        edit(bench)
        mine = bench.session.state.scene
        write(path, OTHER)
        tell(bench)
        bench.tap(Key.F5)
        assert bench.session.state.scene.spheres[0].diameter == 7
        bench.tap(Key.CONTROL_L, Key.Z)
        assert bench.session.state.scene is mine


class Watch:
    """A watched file: the watcher takes its looks when the test says so."""

    def __init__(self, path: Path) -> None:
        self.told = 0  # how often the watcher said that the file has changed
        self.disk = WatchedFile(path)
        self._allowed = threading.Semaphore(0)
        self._taken = 0
        self._begun = 0

    def start(self) -> None:
        self.disk.watch(self._tell)

    def look(self, times: int = 1) -> None:
        """Let the watcher look so often; returns when it begins the next look, so it has said what it had to say."""
        self._taken += times
        self._allowed.release(times)
        until(lambda: self._begun == self._taken + 1, "a look at the file")

    def signature(self, path: Path) -> Signature:
        """In the place of `minirt.viewer.files.watched_file.signature`."""
        if threading.current_thread().name == "minirt-watch":
            self._begun += 1
            self._allowed.acquire(timeout=HANG_LIMIT)
        return signature(path)

    def close(self) -> None:
        self.disk.close()
        self._allowed.release()

    def _tell(self) -> None:
        self.told += 1


class TestDisk:
    @pytest.fixture
    def watch(self, path, monkeypatch) -> Iterator[Watch]:
        monkeypatch.setattr(watched_file, "INTERVAL", 0.001)
        watch = Watch(path)
        monkeypatch.setattr(watched_file, "signature", watch.signature)
        watch.start()
        yield watch
        watch.close()

    def test_a_change_is_told_once(self, path, watch):
        watch.look(4)
        assert watch.told == 0
        write(path, OTHER)
        watch.look()
        assert watch.told == 0  # it may still be written
        watch.look()
        assert watch.told == 1
        watch.look(4)
        assert watch.told == 1
        assert watch.disk.changed

    def test_what_we_wrote_ourselves_is_not_told(self, path, watch):
        path.write_text(OTHER)
        watch.disk.accept(signature(path))
        watch.look(4)
        assert watch.told == 0
        assert not watch.disk.changed

    def test_a_file_that_is_still_written_is_waited_for(self, path, monkeypatch):
        looks = [(1, 1, 1), (2, 2, 1), (3, 3, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1), (4, 4, 1)]
        seen: list[object] = []

        def look(_path) -> object:
            seen.append(looks[min(len(seen), len(looks) - 1)])
            return seen[-1]

        monkeypatch.setattr(watched_file, "signature", look)
        monkeypatch.setattr(watched_file, "INTERVAL", 0.001)
        watched = WatchedFile(path)
        told: list[int] = []
        watched.watch(lambda: told.append(len(seen)))
        until(lambda: len(seen) > len(looks), "enough looks")
        watched.close()
        assert told == [5]

    def test_a_file_that_goes_is_no_news(self, path, watch):
        path.unlink()
        watch.look(4)
        assert watch.told == 0
        assert not watch.disk.changed
        path.write_text(TEXT)
        watch.look(2)
        assert watch.told == 1


class TestDrop:
    def test_another_file_is_opened(self, bench, path, tmp_path):
        other = tmp_path / "other one.rt"
        other.write_text(OTHER)
        bench.memory.drop(str(other))
        bench.memory.play()
        session = bench.session
        assert session.path == other
        assert session.win.title == "miniRT - other one.rt"
        assert session.state.scene.spheres[0].diameter == 7
        assert session.state.undo_stack == ()
        bench.tap(Key.TAB)
        bench.tap(Key.D)
        bench.tap(Key.CONTROL_L, Key.S)
        assert path.read_text() == TEXT
        assert other.read_text() != OTHER

    def test_what_was_not_saved_is_kept(self, bench, path, tmp_path):
        edit(bench)
        mine = bench.session.state.scene
        other = tmp_path / "other.rt"
        other.write_text(OTHER)
        bench.memory.drop(str(other))
        bench.memory.play()
        kept = path.with_name("scene.recovered.rt")
        assert load(kept).scene.items == mine.items
        assert str(kept) in bench.session.state.message

    @pytest.mark.parametrize(("name", "text"), [("broken.rt", BROKEN), ("picture.png", "x"), ("none.rt", None)])
    def test_what_is_no_scene_is_a_message(self, bench, path, tmp_path, name, text):
        if text:
            (tmp_path / name).write_text(text)
        before = bench.session.state.scene
        bench.memory.drop(str(tmp_path / name))
        bench.memory.play()
        assert bench.session.state.scene is before
        assert bench.session.path == path
        assert name in bench.session.state.message


def test_a_change_that_comes_with_no_thread_is_seen_by_hand(bench, path):
    write(path, OTHER)
    file_changed(bench.session)
    assert bench.session.state.scene.spheres[0].diameter == 7
