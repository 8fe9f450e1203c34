"""Cache of kernels: damaged files heal, folders of others are not used, and no fault of the disk prevents a picture."""

from __future__ import annotations

import errno
import os
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code.cache import CodeCache, ObjectCode, pack, unpack
from minirt.kernel.machine_code.library import Library
from tests.kernel.machine_code.small_kernels import call, double, file_of, is_found, square
from tests.lines import next_line
from tests.paths import ROOT
from tests.processes import fork, started
from tests.waiting import HANG_LIMIT

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="there are neither owners nor modes, nor locks")
KERNEL = ObjectCode("f", 2, b"\x7fELF machine code")
NOW = 1.7e9  # any time in the past
WAITING = """
import sys
from pathlib import Path
from minirt.kernel.machine_code import cache
from tests.kernel.machine_code.small_kernels import double, is_found

def wait(seconds, sleep=cache.time.sleep):
    print("waiting", flush=True)
    cache.time.sleep = sleep

cache.time.sleep = wait
print(is_found(double, Path(sys.argv[1])))
"""


@pytest.fixture(autouse=True)
def fresh_notices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test see its notices as if none had been given before."""
    monkeypatch.setattr(cache, "TOLD", set())


def is_refused(data: bytes, identity: str = "a kernel") -> bool:
    """Whether a packed kernel is found to be damaged."""
    try:
        unpack(identity, data)
    except ValueError:
        return True
    return False


def test_every_flipped_bit_and_every_other_length_or_identity_is_noticed() -> None:
    data = pack("a kernel", KERNEL)
    assert unpack("a kernel", data) == KERNEL
    for bit in range(8 * len(data)):
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        assert is_refused(bytes(changed))
    assert all(is_refused(data[:length]) for length in range(len(data)))
    assert is_refused(data + b"\0")
    assert is_refused(data, "another kernel")


def damages(good: bytes, other: bytes) -> Iterator[bytes]:
    """Yield damaged files: cut off, bits flipped, parts zeroed, longer, or of another kernel."""
    chance = random.Random(1)
    yield from (good[:length] for length in (0, 1, 16, 24, 40, len(good) // 2, len(good) - 1))
    for _ in range(12):
        at = chance.randrange(len(good))
        yield good[:at] + bytes([good[at] ^ 1 << chance.randrange(8)]) + good[at + 1 :]
    yield from (other, good + good, b"\0" + good, bytes(len(good)))


def test_damaged_truncated_and_exchanged_files_heal(tmp_path: Path) -> None:
    assert (is_found(double, tmp_path), is_found(square, tmp_path)) == (False, False)
    path = file_of(double, tmp_path)
    for damaged in damages(path.read_bytes(), file_of(square, tmp_path).read_bytes()):
        path.write_bytes(damaged)
        assert not is_found(double, tmp_path), "a damaged kernel was used"
        assert is_found(double, tmp_path), "the damage was not healed"


def failing(code: int) -> Any:
    """Return a function that fails as the disk would."""

    def fail(*_: object, **__: object) -> None:
        raise OSError(code, os.strerror(code))

    return fail


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EROFS])
@pytest.mark.parametrize(("owner", "call"), [(os, "fsync"), (Path, "replace"), (Path, "read_bytes")])
def test_a_kernel_that_cannot_be_written_or_read_is_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, code: int, owner: Any, call: str
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(owner, call, failing(code))
        assert (is_found(double, tmp_path), is_found(square, tmp_path)) == (False, False)
    (told,) = caplog.messages
    assert told.startswith("notice: ")
    assert os.strerror(code) in told
    left = {path.suffix for path in tmp_path.iterdir()} - {".lock"}
    assert left == ({".kernel"} if call == "read_bytes" else set()), "something half written is left behind"
    assert is_found(double, tmp_path) == (call == "read_bytes")
    assert is_found(double, tmp_path)


def test_a_folder_that_is_deleted_meanwhile_does_no_harm(tmp_path: Path) -> None:
    assert not is_found(double, tmp_path / "gone")
    folder = CodeCache(tmp_path / "gone")
    with folder.compiling_once("a kernel"):  # without a lock
        assert folder.read("a kernel") is None


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of the user, empty."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


@POSIX
def test_the_folder_is_closed_to_others_whatever_the_umask(home: Path) -> None:
    before = os.umask(0)
    try:
        folder = cache.folder()
        assert folder
        folder.chmod(0o755)
        assert cache.folder() == folder
        assert [each.stat().st_mode & 0o777 for each in (folder, folder.parent)] == [0o700] * 2
    finally:
        os.umask(before)


@POSIX
@pytest.mark.parametrize("bits", [0o720, 0o702, 0o777])
@pytest.mark.parametrize("depth", [0, 1])
def test_a_folder_that_others_may_write_is_not_used(
    home: Path, caplog: pytest.LogCaptureFixture, bits: int, depth: int
) -> None:
    """Neither the folder of kernels nor minirt, in which it is."""
    folder = cache.folder()
    assert folder
    unsafe = (folder, folder.parent)[depth]
    unsafe.chmod(bits)
    assert cache.folder() is None
    assert cache.folder() is None
    (told,) = caplog.messages
    assert told.endswith(f"other users may write {unsafe}; chmod go-w '{unsafe}' mends that")
    assert unsafe.stat().st_mode & 0o777 == bits, "what others may have put there stays out of use"


@POSIX
def test_a_folder_of_another_user_is_not_used(
    home: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    assert cache.folder()
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    assert cache.folder() is None
    assert "belongs to another user" in caplog.messages[0]


@pytest.mark.parametrize("is_file", [True, False])
def test_without_a_folder_nothing_is_kept(home: Path, monkeypatch: pytest.MonkeyPatch, is_file: bool) -> None:
    """Where a file has its name, and on a disk that is read only."""
    if is_file:
        (home / "minirt").touch()
    else:
        monkeypatch.setattr(os, "utime", failing(errno.EROFS))
    assert cache.folder() is None


def test_the_folders_that_were_used_last_are_kept(home: Path) -> None:
    current = cache.folder()
    assert current
    for age in range(cache.OTHER_VERSIONS + 5):
        old = current.parent / f"kernels-{age}"
        old.mkdir()
        (old / "file").touch()
        os.utime(old, (NOW - 1000 * age,) * 2)
    (current.parent / "other").mkdir()
    os.utime(current, (0, 0))
    assert cache.folder() == current
    kept = {path.name for path in current.parent.iterdir()}
    assert kept == {current.name, "other", *(f"kernels-{age}" for age in range(cache.OTHER_VERSIONS))}
    cache.delete_old_folders(current.parent / "kernels-of-other-sources")
    assert current.exists(), "it was used last"


def test_kernels_of_older_sources_are_deleted(tmp_path: Path) -> None:
    folder = CodeCache(tmp_path)
    for each in ("old", "new"):
        folder.write(each, KERNEL)
    (tmp_path / "README").touch()
    folder.delete_others(["new", "another"])
    assert set(tmp_path.iterdir()) == {folder.file_of("new"), tmp_path / "README"}
    assert sys.platform == "win32" or folder.file_of("new").stat().st_mode & 0o777 == 0o644


@POSIX
def test_a_program_waits_for_another_that_compiles_the_same_kernel(tmp_path: Path) -> None:
    """This one compiles until the second waits for it."""
    folder, other = tmp_path / "folder", tmp_path / "other"
    for each in (folder, other):
        each.mkdir(mode=0o700)
    assert not is_found(double, other)
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", WAITING, str(folder)]
    with started(command, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True) as second:
        with CodeCache(folder).compiling_once(Library().identity(call(double))):
            assert next_line(second) == "waiting"
            shutil.copy(file_of(double, other), file_of(double, folder))
        assert second.communicate(timeout=HANG_LIMIT)[0] == "True\n"


@POSIX
@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
def test_a_lock_is_free_although_a_forked_process_has_its_file_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, path = CodeCache(tmp_path), CodeCache(tmp_path).file_of("a kernel").with_suffix(".lock")
    monkeypatch.setattr(cache, "PATIENCE", 0.0)  # a lock that is held for too long is passed over

    def is_free() -> bool:
        with path.open("w") as file:
            return cache.file_io.lock(file.fileno())

    reader, writer = os.pipe()
    with folder.compiling_once("a kernel"), folder.compiling_once("a kernel"):
        wait = fork(lambda: (os.close(writer), os.read(reader, 1)))  # until the parent process closes the other end
        assert not is_free()
    assert is_free()
    os.close(writer)
    assert wait() == 0
    os.close(reader)
