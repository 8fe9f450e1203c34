"""Journals: what was not saved can be read back, whenever the program was killed."""

from __future__ import annotations

import errno
import os
import stat
import sys
from pathlib import Path

import pytest

from minirt.errors import FileError
from minirt.scene import Scene, dump, load
from minirt.viewer.files import signature
from minirt.viewer.recovery import journal, journal_file
from minirt.viewer.recovery.journal import Journal, Version
from minirt.viewer.recovery.journal_folder import KEPT, abandoned_journals, is_abandoned, journal_folder
from tests.viewer.fake import TEXT


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file


@pytest.fixture
def book():
    book = Journal()
    yield book
    book.close(delete=False)


def grown(scene: Scene, diameter: float) -> Scene:
    """Return the scene with its sphere of another size."""
    return scene.replace(scene.spheres[0], diameter=diameter)


def keep(book: Journal, scene: Scene, saved: Scene, path) -> None:
    """Keep a version and wait until it is on disk."""
    book.keep(Version(scene, saved, path, signature(path)))
    book.flush()


def test_each_version_can_be_read_back(book, path):
    saved = scene = load(path).scene
    for diameter in (3.0, 4.0, 5.0):
        scene = grown(scene, diameter)
        keep(book, scene, saved, path)
        assert journal_file.read(book.path) == (path, TEXT, dump(scene))


def test_a_new_journal_takes_the_place_of_one_that_has_grown(book, path, monkeypatch):
    monkeypatch.setattr(journal, "MOST_CHANGES", 1000)
    saved = load(path).scene
    sizes, paths = [], set()
    for number in range(200):
        scene = grown(saved, 3.0 + number)
        keep(book, scene, saved, path)
        assert journal_file.read(book.path) == (path, TEXT, dump(scene))
        assert list(journal_folder().iterdir()) == [book.path]
        sizes.append(book.path.stat().st_size)
        paths.add(book.path)
    assert max(sizes) < sizes[0] + 1100
    assert 2 < len(paths) < 20


def test_a_cut_journal_gives_an_earlier_version(book, path, tmp_path):
    saved = scene = load(path).scene
    versions = [TEXT]
    for diameter in (3.0, 4.0, 5.0):
        scene = grown(scene, diameter)
        keep(book, scene, saved, path)
        versions.append(dump(scene))
    whole = book.path.read_bytes()
    base = len(journal_file.beginning(path, TEXT.encode()))
    found = []
    for length in range(len(whole) + 1):
        cut = tmp_path / "cut.journal"
        cut.write_bytes(whole[:length])
        if length < base:
            with pytest.raises((ValueError, KeyError)):
                journal_file.read(cut)
        else:
            found.append(versions.index(journal_file.read(cut).text))
    assert found == sorted(found)
    assert set(found) == {0, 1, 2, 3}


def test_nothing_is_kept_while_nothing_is_unsaved(book, path):
    saved = load(path).scene
    keep(book, saved, saved, path)
    moved = saved.replace(saved.camera, position=(1.0, 2.0, 3.0))  # looking around is no unsaved change
    keep(book, moved, saved, path)
    assert book.path is None
    assert list(abandoned_journals(path)) == []


def test_a_save_and_an_undo_delete_the_journal(book, path):
    saved = load(path).scene
    for back in (lambda scene: (scene, scene), lambda _: (saved, saved)):
        changed = grown(saved, 3.0)
        keep(book, changed, saved, path)
        old = book.path
        assert old.exists()
        keep(book, *back(changed), path)
        assert not old.exists()
        assert book.path is None


@pytest.mark.parametrize("changed", ["# something else\n" + TEXT, TEXT.replace("L 5,5,5", "L 6,6,6")])
def test_a_file_that_another_program_changed_is_not_taken_for_the_saved_scene(book, path, changed):
    saved, known = load(path).scene, signature(path)
    path.write_text(changed)
    assert signature(path) != known
    book.keep(Version(grown(saved, 3.0), saved, path, known))
    book.flush()
    assert journal_file.read(book.path).text == dump(grown(saved, 3.0))


@pytest.mark.parametrize(
    ("platform", "folder"),
    [("linux", ".local/state"), ("darwin", "Library/Application Support"), ("win32", "AppData/Local")],
)
def test_journals_are_where_the_system_keeps_the_state_of_programs(platform, folder, tmp_path, monkeypatch):
    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "AppData/Local"))
    monkeypatch.setattr(sys, "platform", platform)
    assert journal_folder() == tmp_path / folder / "minirt" / "journals"


def test_others_cannot_read_a_journal(book, path):
    saved = load(path).scene
    keep(book, grown(saved, 3.0), saved, path)
    assert stat.S_IMODE(book.path.stat().st_mode) == 0o600
    assert stat.S_IMODE(journal_folder().stat().st_mode) == 0o700


def test_only_the_journals_of_programs_that_ended_are_offered(path):
    first, second = Journal(), Journal()
    saved = load(path).scene
    for book in (first, second):
        keep(book, grown(saved, 3.0), saved, path)
    assert list(abandoned_journals(path)) == []
    left = first.path
    first.close(delete=False)
    assert list(abandoned_journals(path)) == [left]
    assert not is_abandoned(second.path)
    second.close(delete=True)
    assert list(abandoned_journals(path)) == [left]


def left_journal(path) -> Path:
    """Leave the journal of a program that was killed; return its path."""
    book = Journal()
    saved = load(path).scene
    keep(book, grown(saved, 3.0), saved, path)
    left = book.path
    book.close(delete=False)
    assert left
    return left


def test_old_journals_are_deleted(path):
    left = left_journal(path)
    now = left.stat().st_mtime
    os.utime(left, (now - KEPT + 1000,) * 2)
    assert list(abandoned_journals(path)) == [left]
    os.utime(left, (now - KEPT - 1000,) * 2)
    assert list(abandoned_journals(path)) == []
    assert not left.exists()


@pytest.mark.parametrize("seconds", [1, 2**33])
def test_a_journal_that_a_wrong_clock_has_dated_is_kept_from_now_on(path, seconds):
    """A machine without a battery begins in 1970; another clock was set into the future."""
    left = left_journal(path)
    now = left.stat().st_mtime
    os.utime(left, (seconds, seconds))
    for _ in range(2):
        assert list(abandoned_journals(path)) == [left]
        assert left.stat().st_mtime >= now


def test_the_journal_of_a_running_program_is_not_deleted_however_old_it_is(book, path):
    saved = load(path).scene
    keep(book, grown(saved, 3.0), saved, path)
    os.utime(book.path, (book.path.stat().st_mtime - KEPT - 1000,) * 2)
    assert list(abandoned_journals(path)) == []
    assert book.path.exists()


def test_a_taken_journal_is_deleted_when_its_changes_are_kept(book, path, tmp_path):
    other = tmp_path / "other.journal"
    other.touch()
    book.replace(other)
    saved = load(path).scene
    keep(book, saved, saved, path)
    assert other.exists()
    keep(book, grown(saved, 3.0), saved, path)
    assert not other.exists()


def test_a_full_disk_gives_one_notice_and_the_next_change_tries_again(book, path, monkeypatch, caplog):
    def full(_descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    saved = load(path).scene
    keep(book, grown(saved, 3.0), saved, path)
    first = book.path
    with monkeypatch.context() as patch:
        patch.setattr(journal.os, "fsync", full)
        keep(book, grown(saved, 4.0), saved, path)
        keep(book, grown(saved, 5.0), saved, path)
    assert caplog.text.count("No space left on device") == 1
    assert list(journal_folder().iterdir()) == [first]  # what it holds is all that there is
    keep(book, grown(saved, 6.0), saved, path)
    assert journal_file.read(book.path).text == dump(grown(saved, 6.0))
    assert not first.exists()


@pytest.mark.parametrize(
    "data", [b"", b"\n", b"[1]\n", b'{"journal": 2}\n', b'{"journal": 1, "file": "a", "bytes": 9}\nab\n', b"\xff\n"]
)
def test_a_damaged_journal_is_refused(tmp_path, data):
    damaged = tmp_path / "damaged.journal"
    damaged.write_bytes(data)
    with pytest.raises((ValueError, KeyError)):
        journal_file.read(damaged)


def test_a_journal_that_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(FileError):
        journal_file.read(tmp_path / "fifo")
