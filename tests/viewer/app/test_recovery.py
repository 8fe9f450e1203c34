"""Recovery in a session: unsaved changes are kept on disk while it runs, and offered when the scene is opened again."""

from __future__ import annotations

import os

import pytest

from minirt.mlx import Key
from minirt.scene import dump, load
from minirt.viewer.app import desktop
from minirt.viewer.app.commands import offer_found
from minirt.viewer.app.desktop import end_recovery, lose_window
from minirt.viewer.files import WatchedFile
from minirt.viewer.recovery import Recovery, state_folder
from tests.viewer.fake import TEXT, scene
from tests.viewer.session_harness import SessionHarness


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    os.utime(file, (1000, 1000))
    return file


def opened(path) -> SessionHarness:
    """Open the scene as the program does."""
    harness = SessionHarness()
    harness.session.path, harness.session.file = path, WatchedFile(path)
    harness.session.recovery = Recovery()
    offer_found(harness.session)
    harness.finish(0.001)
    return harness


def killed_after_an_edit(path) -> str:
    """Edit the scene in a program that is killed; return the text of the edited scene."""
    harness = opened(path)
    edit(harness)
    harness.session.recovery.flush()
    harness.session.recovery.close(delete=False)
    return dump(harness.session.state.scene)


def edit(harness: SessionHarness) -> None:
    """Make an unsaved change: move the second element, a light."""
    harness.tap(Key.TAB)
    harness.tap(Key.D)


def kept() -> list[str]:
    """Return the names of all files with unsaved changes."""
    return [each.name for each in state_folder().glob("*.rt")]


def test_the_changes_of_a_killed_program_are_offered_and_taken(path):
    edited = killed_after_an_edit(path)
    harness = opened(path)
    assert "unsaved changes of " in harness.session.screen.banner
    assert "found: Ctrl+R takes them" in harness.session.screen.banner
    assert harness.session.state.scene == scene()
    harness.tap(Key.CONTROL_L, Key.R)
    assert dump(harness.session.state.scene) == edited
    assert harness.session.screen.banner == ""
    harness.session.recovery.flush()
    assert len(kept()) == 1  # that of this session
    assert harness.session.recovery.path.read_text() == edited
    harness.tap(Key.CONTROL_L, Key.S)
    assert path.read_text() == edited
    harness.session.recovery.flush()
    assert kept() == []
    end_recovery(harness.session)
    assert "unsaved" not in opened(path).session.screen.banner


def test_taken_changes_can_be_undone(path):
    killed_after_an_edit(path)
    harness = opened(path)
    harness.tap(Key.F5)
    harness.tap(Key.CONTROL_L, Key.Z)
    assert dump(harness.session.state.scene) == TEXT
    harness.tap(Key.F5)
    assert "read again" in harness.session.state.message
    end_recovery(harness.session)


def test_changes_that_nobody_takes_are_offered_again(path):
    killed_after_an_edit(path)
    for _ in range(2):
        harness = opened(path)
        assert "Ctrl+R takes them" in harness.session.screen.banner
        end_recovery(harness.session)
        assert not path.with_name("scene.recovered.rt").exists()


def test_a_clean_end_with_unsaved_changes_leaves_a_recovery_file_that_is_offered(path):
    harness = opened(path)
    edit(harness)
    end_recovery(harness.session)
    copy = path.with_name("scene.recovered.rt")
    assert kept() == []
    harness = opened(path)
    assert "(scene.recovered.rt) found" in harness.session.screen.banner
    harness.tap(Key.F5)
    assert dump(harness.session.state.scene) == copy.read_text()
    assert copy.exists()
    end_recovery(harness.session)


def test_changes_stay_kept_where_no_recovery_file_can_be_written(path, monkeypatch):
    harness = opened(path)
    edit(harness)
    harness.session.recovery.flush()

    def fail(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(desktop, "save_recovery", fail)
    with pytest.raises(OSError):  # noqa: PT011 - any
        end_recovery(harness.session)
    assert len(kept()) == 1


def test_lost_connections_keep_changes_and_end_nothing(path, capsys):
    harness = opened(path)
    edit(harness)
    lose_window(harness.session)
    copy = path.with_name("scene.recovered.rt")
    assert str(copy) in capsys.readouterr().out
    assert load(copy).scene.items == harness.session.state.scene.items


def test_changes_with_an_error_are_said_and_kept(path):
    copy = path.with_name("scene.recovered.rt")
    copy.write_text(TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -2"))
    harness = opened(path)
    harness.tap(Key.F5)
    assert "sphere diameter must be > 0" in harness.session.state.message
    assert copy.exists()
    end_recovery(harness.session)


def test_another_file_that_is_opened_offers_its_own_changes(path, tmp_path):
    other = tmp_path / "other.rt"
    other.write_text(TEXT)
    os.utime(other, (1000, 1000))
    edited = killed_after_an_edit(other)
    harness = opened(path)
    harness.memory.drop(str(other))
    harness.memory.play()
    assert "Ctrl+R takes them" in harness.session.screen.banner
    harness.tap(Key.F5)
    assert dump(harness.session.state.scene) == edited
    end_recovery(harness.session)
