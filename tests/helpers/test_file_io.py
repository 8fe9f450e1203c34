"""Files are written whole, replace only what they may, keep who may read them, and are read if they are regular."""

from __future__ import annotations

import errno
import os
import stat
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.helpers.file_io import writing
from minirt.viewer.files import create_numbered


def names(folder: Path) -> list[str]:
    """Return the names of a folder's files."""
    return sorted(each.name for each in folder.iterdir())


def test_a_new_file_never_replaces_one(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "b").symlink_to("nowhere")
    for name in "ab":
        with pytest.raises(FileExistsError):
            file_io.create(tmp_path / name, b"new")
    file_io.create(tmp_path / "c", b"new")
    assert (tmp_path / "a").read_bytes() == b"old"
    assert (tmp_path / "c").read_bytes() == b"new"
    assert names(tmp_path) == ["a", "b", "c"]


def test_file_systems_without_hard_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    file_io.create(tmp_path / "a", b"new")
    assert (tmp_path / "a").read_bytes() == b"new"
    with pytest.raises(FileExistsError):
        file_io.create(tmp_path / "a", b"other")
    assert names(tmp_path) == ["a"]


def test_copies_of_many_writers_at_once_are_all_there(tmp_path: Path) -> None:
    start = threading.Barrier(12)

    def write(writer: int) -> None:
        start.wait()
        for n in range(5):
            create_numbered(tmp_path / "scene.rt", ".rt", f"{writer} {n}".encode())

    threads = [threading.Thread(target=write, args=(writer,)) for writer in range(12)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert names(tmp_path) == sorted(f"scene-{n}.rt" for n in range(1, 61))
    assert len({each.read_bytes() for each in tmp_path.iterdir()}) == 60


def test_a_private_file_is_private_at_every_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "private"
    path.write_bytes(b"old")
    path.chmod(0o600)
    modes = []
    for name in ("fsync", "replace"):
        target = os if name == "fsync" else Path
        original = getattr(target, name)

        def watched(first: object, *others: object, original: object = original) -> object:
            modes.extend(stat.S_IMODE(each.stat().st_mode) for each in tmp_path.iterdir())
            return original(first, *others)  # type: ignore[operator]

        monkeypatch.setattr(target, name, watched)
    file_io.write(path, b"new")
    assert len(modes) == 4
    assert set(modes) == {0o600}


def test_extended_attributes_stay(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"old")
    try:
        os.setxattr(path, "user.comment", b"kept")
    except (AttributeError, OSError):
        pytest.skip("this file system has no extended attributes")
    file_io.write(path, b"new")
    assert os.getxattr(path, "user.comment") == b"kept"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may give files away")
def test_the_owner_stays(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"old")
    os.chown(path, 12345, 54321)
    path.chmod(0o640)
    file_io.write(path, b"new")
    status = path.stat()
    assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (12345, 54321, 0o640)


@pytest.mark.parametrize("size", [0, 1, 999, 1000, 1001])
def test_files_up_to_the_limit_are_read_whole(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a"
    path.write_bytes(os.urandom(size))
    if size <= 1000:
        assert file_io.read(path, 1000) == path.read_bytes()
    else:
        with pytest.raises(FileError, match="larger than 1000 B"):
            file_io.read(path, 1000)


def test_old_temporary_files_of_killed_programs_are_swept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only they: not those that a program may still write, other names, folders, nor what a link leads to."""
    monkeypatch.setattr(writing, "SWEPT", set())
    folder, elsewhere = tmp_path / "work", tmp_path / "elsewhere"
    names = [writing.TEMPORARY.replace("*", f"{number:016x}") for number in range(4)]
    old, young, is_link, is_folder = (folder / each for each in names)
    others = [folder / each for each in ("scene.rt", ".minirt-1.tmp", f"{names[0]}~", names[0].replace("0", "g"))]
    folder.mkdir()
    for each in (old, young, elsewhere, *others):
        each.write_bytes(b"old")
    is_link.symlink_to(elsewhere)
    is_folder.mkdir()
    for each in (old, elsewhere, is_folder, *others):
        os.utime(each, (1000, 1000))
    file_io.create(folder / "new", b"new")
    assert {*folder.iterdir()} == {young, is_link, is_folder, *others, folder / "new"}
    assert elsewhere.read_bytes() == b"old"


def test_a_folder_is_searched_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A film of many pictures does not read its folder for each. A folder that cannot be read does not matter."""
    searched: list[str] = []

    def scan(folder: str) -> Any:
        searched.append(folder)
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(os, "scandir", scan)
    for number in range(3):
        file_io.write(tmp_path / f"{number}", b"new")
    assert searched == [str(tmp_path)]


def test_a_failing_disk_does_not_keep_a_lock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux closes a file even where it reports an error."""
    close = os.close

    def failing(descriptor: int) -> None:
        close(descriptor)
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    first, second = (os.open(tmp_path / "lock", os.O_RDWR | os.O_CREAT) for _ in range(2))
    assert file_io.lock(first)
    assert sys.platform == "win32" or not file_io.lock(second)
    with monkeypatch.context() as patch:
        patch.setattr(os, "close", failing)
        file_io.unlock(first)
    assert file_io.lock(second)
    os.close(second)
