"""Files of a session: saving, copies, reloading, screenshots, recovery."""

from __future__ import annotations

import os
import threading

import pytest

from minirt.helpers.file_io import stamps
from minirt.scene import load
from minirt.viewer.app.replay import play
from minirt.viewer.files import WatchedFile, contents_differ, save_recovery
from tests.viewer.fake import TEXT, FakeRenderer, played, scene, write
from tests.waiting import until

SELECT_SPHERE = ("press Tab", "press Tab")
OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")


def test_a_scene_or_picture_that_cannot_be_written_gives_a_message(tmp_path):
    session = played("press d", "press Ctrl+S", path=tmp_path / "none" / "scene.rt")
    assert "cannot be written" in session.state.message
    assert session.saved is not session.state.scene
    assert "cannot be written" in played("press P", path=tmp_path / "none" / "scene.rt").state.message


def test_copies_are_numbered(path):
    played(*SELECT_SPHERE, "press Delete", "press Ctrl+Shift+S", "press Ctrl+Shift+S", path=path)
    assert path.read_text() == TEXT
    for name in ("scene-1.rt", "scene-2.rt"):
        assert load(path.with_name(name)).scene.spheres == ()


@pytest.mark.skipif(os.name == "nt", reason="a folder that does not exist is the same everywhere else")
def test_a_recovered_scene_goes_to_a_temporary_folder_if_it_cannot_be_beside_the_file(tmp_path):
    copy = save_recovery(scene(), tmp_path / "none" / "scene.rt")
    assert copy.name == "scene.recovered.rt"
    assert load(copy).scene.items == scene().items
    copy.unlink()
    copy.parent.rmdir()


def test_a_tone_that_a_key_makes_that_of_the_file_again_is_no_change(path):
    saved = load(path).scene
    shown = saved.replace(saved.camera, tone="filmic", exposure=1.0)
    keys = ["press C", "press T", "press d"]
    session = play(shown, keys, renderer=FakeRenderer(), size=(64, 48), path=path, saved=saved)
    assert session.state.scene.camera.tone == saved.camera.tone == "plain"
    assert not contents_differ(session.state.scene, session.saved)


# File watching: changes by other programs are reported once, as soon as the file is stable.


def reports(watched: WatchedFile, checks: int) -> list[int]:
    """Return the numbers, from 1, of the checks that report a change."""
    return [number for number in range(1, checks + 1) if watched.check()]


def test_a_change_is_reported_once_as_soon_as_the_file_is_stable(path):
    watched = WatchedFile(path)
    assert reports(watched, 4) == []
    for text in (OTHER, OTHER + OTHER):
        write(path, text)
        assert reports(watched, 1) == []  # it may still be written
    assert reports(watched, 4) == [1]
    assert watched.changed


def test_writes_of_the_viewer_itself_are_not_reported(path):
    watched = WatchedFile(path)
    path.write_text(OTHER)
    watched.accept(stamps(path))
    assert reports(watched, 4) == []
    assert not watched.changed


def test_a_deleted_file_is_reported_once_and_again_when_it_is_back(path):
    watched = WatchedFile(path)
    assert not watched.missing
    assert not WatchedFile(path.with_name("none.rt")).missing
    path.unlink()
    assert reports(watched, 4) == [2]
    assert watched.missing
    assert not watched.changed
    path.write_text(TEXT)
    assert reports(watched, 2) == [2]
    assert not watched.missing


def test_a_thread_checks_the_file_until_it_is_closed(path):
    watched, notified = WatchedFile(path), threading.Event()
    watched.watch(notified.set)
    write(path, OTHER)
    until(notified.is_set, "the report")
    watched.close()
    until(lambda: all(each.name != "minirt-watch" for each in threading.enumerate()), "the end of the thread")
