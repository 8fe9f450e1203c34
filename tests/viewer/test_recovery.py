"""Recovery: what was not saved can be read back, whenever the program was killed, and is offered if it is news."""

from __future__ import annotations

import errno
import os
import stat
import time
from pathlib import Path

import pytest

from minirt.helpers.file_io import writing
from minirt.scene import Scene, dump, files, load
from minirt.viewer.recovery import KEPT, FoundChanges, Recovery, Version, find_changes, state_folder
from tests.guards import must_end, must_not_open
from tests.viewer.fake import TEXT

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    file = tmp_path / "scene [1].rt"
    file.write_text(TEXT)
    set_time(file, 1000)
    return file


@pytest.fixture
def recovery():
    recovery = Recovery()
    yield recovery
    recovery.close(delete=False)


def set_time(path: Path, seconds: float) -> None:
    """Set the modification time of a file."""
    os.utime(path, (seconds, seconds))


def grown(scene: Scene, diameter: float) -> Scene:
    """Return the scene with its sphere of another size."""
    return scene.replace(scene.spheres[0], diameter=diameter)


def keep(recovery: Recovery, scene: Scene, saved: Scene, path: Path) -> None:
    """Keep a version and wait until it is on disk."""
    recovery.keep(Version(scene, saved, path))
    recovery.flush()


def left_by_a_killed_program(path: Path, diameter: float = 9.0) -> Path:
    """Leave unsaved changes of a program that was killed; return their file."""
    recovery, saved = Recovery(), load(path).scene
    keep(recovery, grown(saved, diameter), saved, path)
    left = recovery.path
    recovery.close(delete=False)
    assert left
    return left


def beside(path: Path, text: str, seconds: float, number: str = "") -> Path:
    """Write a recovered file of a scene."""
    file = path.with_name(f"{path.stem}.recovered{number}.rt")
    file.write_text(text)
    set_time(file, seconds)
    return file


def test_the_newest_version_is_on_disk_for_this_user_alone(recovery, path):
    saved = scene = load(path).scene
    for diameter in (3.0, 4.0, 5.0):
        scene = grown(scene, diameter)
        keep(recovery, scene, saved, path)
        assert recovery.path.read_text() == dump(scene)
        assert {each.suffix for each in state_folder().iterdir()} == {".rt", ".lock"}
    assert {stat.S_IMODE(each.stat().st_mode) for each in state_folder().iterdir()} == {0o600}
    assert stat.S_IMODE(state_folder().stat().st_mode) == 0o700


def test_a_timer_writes_the_last_version(recovery, path, monkeypatch):
    monkeypatch.setattr("minirt.viewer.recovery.INTERVAL", 0.01)
    saved = load(path).scene
    for diameter in (3.0, 4.0):
        recovery.keep(Version(grown(saved, diameter), saved, path))
        timer = recovery._timer
        if timer:
            timer.join()
    assert recovery.path.read_text() == dump(grown(saved, 4.0))


def test_nothing_is_kept_while_nothing_is_unsaved(recovery, path):
    saved = load(path).scene
    keep(recovery, saved, saved, path)
    moved = saved.replace(saved.camera, position=(1.0, 2.0, 3.0))  # looking around is no unsaved change
    keep(recovery, moved, saved, path)
    assert recovery.path is None
    assert not state_folder().exists()
    for back in (lambda scene: (scene, scene), lambda _: (saved, saved)):  # a save, and an undo
        keep(recovery, changed := grown(saved, 3.0), saved, path)
        assert recovery.path.exists()
        keep(recovery, *back(changed), path)
        assert recovery.path is None
        assert list(state_folder().iterdir()) == []


def test_two_programs_do_not_offer_or_delete_each_others_changes(recovery, path):
    saved, second = load(path).scene, Recovery()
    keep(recovery, grown(saved, 3.0), saved, path)
    keep(second, grown(saved, 4.0), saved, path)
    set_time(recovery.path, recovery.path.stat().st_mtime - KEPT - 1000)
    assert recovery.path != second.path
    assert find_changes(path) is None
    second.close(delete=False)
    assert find_changes(path).text == dump(grown(saved, 4.0))
    assert recovery.path.read_text() == dump(grown(saved, 3.0))


@pytest.mark.parametrize(("age", "kept"), [(KEPT - 1000, True), (KEPT + 1000, False)])
def test_changes_are_kept_for_a_month_and_longer_where_they_are_newer_than_the_file(path, age, kept):
    left = left_by_a_killed_program(path)
    set_time(left, time.time() - age)
    assert find_changes(path).path == left
    set_time(path, time.time())
    assert find_changes(path) is None
    assert left.exists() == kept


def test_taken_changes_stay_in_their_file_until_nothing_is_unsaved(recovery, path):
    left, saved = left_by_a_killed_program(path), load(path).scene
    recovery.adopt(left)
    Recovery().adopt(left)  # of another program, which is too late
    assert find_changes(path) is None
    keep(recovery, grown(saved, 3.0), saved, path)
    assert left.read_text() == dump(grown(saved, 3.0))
    keep(recovery, saved, saved, path)
    assert list(state_folder().iterdir()) == []


def test_a_full_disk_gives_one_notice_and_the_next_change_tries_again(recovery, path, monkeypatch, caplog):
    def full(_descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    saved = load(path).scene
    keep(recovery, grown(saved, 3.0), saved, path)
    with monkeypatch.context() as patch:
        patch.setattr(writing.os, "fsync", full)
        keep(recovery, grown(saved, 4.0), saved, path)
        keep(recovery, grown(saved, 5.0), saved, path)
    assert caplog.text.count("No space left on device") == 1
    assert recovery.path.read_text() == dump(grown(saved, 3.0))
    keep(recovery, grown(saved, 6.0), saved, path)
    assert recovery.path.read_text() == dump(grown(saved, 6.0))


def test_the_newest_changes_are_found(path):
    assert find_changes(path) is None
    assert find_changes(path.with_name("missing.rt")) is None
    file = beside(path, OTHER, 2000)
    assert find_changes(path) == FoundChanges(file, 2000, OTHER, beside=True)
    newer = beside(path, OTHER.replace("7", "8"), 3000, "-1")
    assert find_changes(path).path == newer
    left = left_by_a_killed_program(path)
    assert find_changes(path).path == left
    set_time(newer, time.time() + 1000)
    assert find_changes(path).path == newer


@pytest.mark.parametrize(("text", "seconds"), [(OTHER, 999), (TEXT, 2000)])
def test_changes_that_are_older_than_the_file_or_that_it_holds_are_not_offered(path, text, seconds):
    beside(path, text, seconds)
    assert find_changes(path) is None


def test_changes_of_the_version_that_the_file_has_are_newer_whatever_the_clock_said(path):
    set_time(path, time.time() + 3600)  # saved before the clock was set back by an hour
    left = left_by_a_killed_program(path)
    assert find_changes(path).path == left
    path.write_text(OTHER)
    set_time(path, time.time() + 7200)  # another program has saved something else since
    assert find_changes(path) is None


def test_a_file_that_another_program_changed_is_not_taken_for_the_saved_scene(recovery, path):
    saved = load(path).scene
    path.write_text(OTHER)
    recovery.keep(Version(grown(saved, 3.0), saved, path))
    recovery.close(delete=False)
    set_time(path, time.time() + 3600)
    assert find_changes(path) is None


def test_what_cannot_be_read_is_passed_over(path):
    left = left_by_a_killed_program(path)
    for number, make in enumerate([os.mkfifo, os.mkdir, lambda each: each.symlink_to(each)]):
        make(path.with_name(f"{path.stem}.recovered-{number}.rt"))
        make(left.with_stem(f"{left.stem}{number}"))
        make(left.with_stem(f"{left.stem}{number}").with_suffix(".lock"))
    beside(path, OTHER, 1e10, "-9").write_bytes(b"\xff")
    with must_end():
        assert find_changes(path).path == left


@pytest.mark.parametrize("too_large", [False, True])
def test_what_takes_the_place_of_the_scene_is_not_read(recovery, path, too_large):
    saved = load(path).scene
    path.unlink()
    if too_large:
        with path.open("wb") as file:
            file.truncate(files.MAX_BYTES + 1)
    else:
        os.mkfifo(path)
    with must_end(), must_not_open(path):
        assert find_changes(path) is None
        keep(recovery, grown(saved, 3.0), saved, path)
    assert recovery.path.read_text() == dump(grown(saved, 3.0))


@pytest.mark.parametrize("is_beside", [True, False])
def test_the_title_has_the_time_of_day_and_of_another_day_the_date(path, monkeypatch, is_beside):
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    found = FoundChanges(path, 86400 + 14 * 3600 + 3 * 60, "", is_beside)
    assert found.title == f"unsaved changes of 1970-01-02 14:03{' (scene [1].rt)' if is_beside else ''}"
    assert "-" not in found._replace(time=time.time()).title
    monkeypatch.undo()
    time.tzset()


@pytest.mark.parametrize("delete", [True, False])
def test_a_disk_that_fails_at_the_end_does_not_matter(recovery, path, monkeypatch, delete):
    saved, close = load(path).scene, os.close
    keep(recovery, grown(saved, 3.0), saved, path)
    text = dump(grown(saved, 3.0))

    def failing(descriptor):
        close(descriptor)
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    with monkeypatch.context() as patch:
        patch.setattr(os, "close", failing)
        recovery.close(delete=delete)
    assert [each.read_text() for each in state_folder().glob("*.rt")] == ([] if delete else [text])
    assert recovery.path is None
