"""Private files and folders: what others could have written is refused, and locks let others wait."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import pytest

from minirt.kernel.machine_code import private_files
from minirt.kernel.machine_code.private_files import key_of, locked, make_private_folder, read, write
from tests.processes import fork

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="files have no modes there")


def mode(path: Path) -> int:
    """Return the permissions of a file or a folder."""
    return stat.S_IMODE(path.stat().st_mode)


@pytest.fixture
def open_umask() -> object:
    """Let all users write new files unless a program says otherwise."""
    before = os.umask(0)
    yield
    os.umask(before)


@pytest.mark.usefixtures("open_umask")
def test_folders_files_and_keys_are_private_whatever_the_umask(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    make_private_folder(folder)
    write(folder / "file", b"1")
    key = key_of(folder)
    assert mode(folder) == 0o700
    assert mode(folder / "file") == mode(folder / "key") == mode(folder / "key.lock") == 0o600
    assert len(key) == 32
    assert key_of(folder) == key


def test_a_file_that_others_could_write_becomes_private_when_it_is_written(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.touch()
    path.chmod(0o666)
    write(path, b"1")
    assert mode(path) == 0o600


def test_a_readable_folder_is_closed(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    make_private_folder(tmp_path)
    assert mode(tmp_path) == 0o700


@pytest.mark.parametrize("bits", [0o720, 0o702, 0o777])
def test_a_folder_that_others_may_write_is_refused(tmp_path: Path, bits: int) -> None:
    tmp_path.chmod(bits)
    with pytest.raises(PermissionError, match=f"^other users may write {tmp_path}; chmod go-w '{tmp_path}' mends that"):
        make_private_folder(tmp_path)
    assert mode(tmp_path) == bits, "what others may have put there stays out of use"


@pytest.mark.parametrize("bits", [0o620, 0o602])
def test_a_file_that_others_may_write_is_not_read(tmp_path: Path, bits: int) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"1")
    path.chmod(bits)
    with pytest.raises(PermissionError, match="other users may write"):
        read(path)


def test_files_and_folders_of_other_users_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"1")
    assert read(path) == b"1"
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    with pytest.raises(PermissionError, match=f"^{path} belongs to another user"):
        read(path)
    with pytest.raises(PermissionError, match=f"^{tmp_path} belongs to another user"):
        make_private_folder(tmp_path)


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe", 0o600)
    (tmp_path / "folder").mkdir(0o700)
    for name in ("pipe", "folder"):
        with pytest.raises(OSError, match=r"is not a regular file|Is a directory"):
            read(tmp_path / name)


@pytest.mark.parametrize(("data", "bits"), [(b"", 0o600), (b"short", 0o600), (bytes(32), 0o640), (bytes(32), 0o604)])
def test_a_key_that_is_damaged_or_known_to_others_is_replaced(tmp_path: Path, data: bytes, bits: int) -> None:
    path = tmp_path / "key"
    path.write_bytes(data)
    path.chmod(bits)
    key = key_of(tmp_path)
    assert len(key) == 32
    assert key != data
    assert mode(path) == 0o600


def test_a_lock_that_is_held_for_too_long_is_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(private_files, "PATIENCE", 0.0)
    path = tmp_path / "lock"
    with locked(path), locked(path):
        assert path.exists()


def test_without_a_lock_file_work_goes_on(tmp_path: Path) -> None:
    with locked(tmp_path / "missing" / "lock"):
        pass


def is_free(path: Path, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether nobody holds the lock of a file."""
    monkeypatch.setattr(private_files, "PATIENCE", 0.0)
    with path.open("w") as file:
        try:
            private_files.wait_for_lock(file.fileno())
        except BlockingIOError:
            return False
    return True


@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
def test_a_lock_is_free_although_a_forked_process_has_its_file_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "lock"
    reader, writer = os.pipe()
    with locked(path):
        wait = fork(lambda: (os.close(writer), os.read(reader, 1)))  # until the parent process closes the other end
        assert not is_free(path, monkeypatch)
    assert is_free(path, monkeypatch)
    os.close(writer)
    assert wait() == 0
    os.close(reader)
