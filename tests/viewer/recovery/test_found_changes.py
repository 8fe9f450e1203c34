"""Found changes: the last unsaved version of a scene, if it is newer than the file."""

from __future__ import annotations

import os
import time

import pytest

from minirt.scene import load
from minirt.viewer.files import signature
from minirt.viewer.recovery.found_changes import FoundChanges, find_changes
from minirt.viewer.recovery.journal import Journal, Version
from tests.viewer.fake import TEXT

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    file = tmp_path / "scene [1].rt"
    file.write_text(TEXT)
    set_time(file, 1000)
    return file


def set_time(path, seconds: float) -> None:
    """Set the modification time of a file."""
    os.utime(path, (seconds, seconds))


def recovered(path, text: str, seconds: float, number: str = ""):
    """Write a recovery file of a scene."""
    file = path.with_name(f"{path.stem}.recovered{number}.rt")
    file.write_text(text)
    set_time(file, seconds)
    return file


def leave_journal(path):
    """Leave the journal of a program that was killed after an edit; return its path."""
    saved = load(path).scene
    book = Journal()
    book.keep(Version(saved.replace(saved.spheres[0], diameter=9.0), saved, path, signature(path)))
    book.flush()
    left = book.path
    book.close(delete=False)
    return left


def test_a_scene_without_any_has_none(path):
    assert find_changes(path) is None
    assert find_changes(path.with_name("missing.rt")) is None


def test_a_journal_is_found(path):
    left = leave_journal(path)
    found = find_changes(path)
    assert (found.path, found.is_journal) == (left, True)
    assert "sp 0,0,0 9 255,0,0" in found.text


def test_a_recovery_file_is_found_by_its_own_name(path):
    file = recovered(path, OTHER, 2000)
    assert find_changes(path) == FoundChanges(file, 2000, OTHER, is_journal=False)


def test_the_newest_is_found(path):
    recovered(path, OTHER, 2000)
    newer = recovered(path, OTHER.replace("7", "8"), 3000, "-1")
    assert find_changes(path).path == newer
    left = leave_journal(path)
    assert find_changes(path).path == left
    now = left.stat().st_mtime
    set_time(newer, now - 1000)
    set_time(left, now - 2000)
    assert find_changes(path).path == newer
    set_time(left, now - 500)
    assert find_changes(path).path == left


def test_changes_older_than_the_file_are_not_offered(path):
    recovered(path, OTHER, 999)
    assert find_changes(path) is None


def test_changes_of_just_the_text_of_the_file_are_newer_whatever_the_clock_said(path):
    left = leave_journal(path)
    set_time(path, left.stat().st_mtime + 3600)  # saved before the clock was set back by an hour
    found = find_changes(path)
    assert found is not None
    assert found.path == left
    path.write_text(OTHER)
    set_time(path, left.stat().st_mtime + 3600)  # another program has saved something else since
    assert find_changes(path) is None


def test_changes_that_the_file_holds_are_not_offered(path):
    recovered(path, TEXT, 2000)
    assert find_changes(path) is None


@pytest.mark.parametrize(
    "change", [b"3", b"[null, 0, []]", b"[0, 1, null]", b"[1e999, 0, []]", b'[0, 1, ["\\ud800"]]', b"[" * 100_000]
)
def test_a_journal_with_other_values_is_passed_over(path, change):
    left = leave_journal(path)
    with left.open("ab") as file:
        file.write(change + b"\n")
    assert find_changes(path) is None


def test_recovery_files_that_are_no_files_are_passed_over(path):
    os.mkfifo(path.with_name(f"{path.stem}.recovered.rt"))
    path.with_name(f"{path.stem}.recovered-1.rt").mkdir()
    (loop := path.with_name(f"{path.stem}.recovered-2.rt")).symlink_to(loop)
    left = leave_journal(path)
    os.mkfifo(left.with_stem(left.stem + "0"))
    left.with_stem(left.stem + "1").mkdir()
    assert find_changes(path).path == left


@pytest.mark.parametrize("seconds", [1e12, 1e18, -1e18])
def test_changes_of_a_year_that_no_calendar_has_have_a_title(path, seconds):
    found = FoundChanges(path.with_name("a.journal"), seconds, "", is_journal=True)
    assert found.title == "unsaved changes (a.journal)"


def test_what_cannot_be_read_is_passed_over(path):
    file = recovered(path, OTHER, 2000)
    newer = recovered(path, OTHER, 3000, "-1")
    newer.write_bytes(b"\xff")
    set_time(newer, 3000)
    left = leave_journal(path)
    left.write_bytes(b"{}\n")
    assert find_changes(path).path == file


@pytest.mark.parametrize("is_journal", [True, False])
def test_the_title_has_the_time_of_day_and_of_another_day_the_date(path, monkeypatch, is_journal):
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    found = FoundChanges(path, 86400 + 14 * 3600 + 3 * 60, "", is_journal)
    name = "" if is_journal else " (scene [1].rt)"
    assert found.title == f"unsaved changes of 1970-01-02 14:03{name}"
    path.touch()
    now = found._replace(time=path.stat().st_mtime)
    assert "-" not in now.title
    monkeypatch.undo()
    time.tzset()
