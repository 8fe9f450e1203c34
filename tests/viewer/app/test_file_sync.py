"""File sync: no work is lost when another program writes the scene's file."""

from __future__ import annotations

import pytest

from minirt.errors import SceneError
from minirt.mlx import Key
from minirt.scene import load
from minirt.viewer.app.commands import open_another, save_scene
from minirt.viewer.files import WatchedFile
from tests.viewer.fake import TEXT, colour_of, scene
from tests.viewer.session_harness import SessionHarness

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")
BROKEN = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -7")


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
    assert harness.session.state.file_camera == scene().camera
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


def test_a_deleted_file_is_said_until_it_is_written_again(harness, path):
    path.unlink()
    notify(harness)
    assert "scene.rt was deleted by another program: Ctrl+S writes it again" in harness.session.screen.banner
    harness.tap(Key.CONTROL_L, Key.S)
    assert load(path).scene.items == harness.session.state.scene.items
    assert harness.session.screen.banner == ""


def test_a_hard_link_that_saving_cuts_is_said(harness, path):
    other = path.with_name("other.rt")
    other.hardlink_to(path)
    edit(harness)
    harness.tap(Key.CONTROL_L, Key.S)
    assert "its other hard links keep the old scene" in harness.session.state.message
    assert other.read_text() == TEXT
    harness.tap(Key.CONTROL_L, Key.S)
    assert "links" not in harness.session.state.message


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
        assert session.state.undo_stack == ()
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


def test_a_file_that_cannot_be_written_is_not_copied_first(harness, path):
    harness.session.path = path.with_suffix(".txt")
    harness.session.path.write_text(TEXT)
    harness.session.file = WatchedFile(harness.session.path)
    write(harness.session.path, OTHER)
    with pytest.raises(SceneError, match=r"ends in '\.rt'"):
        save_scene(harness.session)
    assert {each.name for each in path.parent.iterdir()} == {"scene.rt", "scene.txt"}


def test_another_file_is_watched_in_place_of_the_first(harness, path, monkeypatch):
    watched = []
    monkeypatch.setattr(harness.session, "watch_file", lambda: watched.append(harness.session.file.path))
    other = path.with_name("other.rt")
    other.write_text(OTHER)
    open_another(harness.session, other)
    assert watched == [other]
