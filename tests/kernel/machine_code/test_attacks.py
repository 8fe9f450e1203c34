"""Attacks on the cache of kernels: 120 damaged files, files and links of other users, and programs that are killed.

Tests with files of other users need root, which can give files away; elsewhere they are skipped.
"""

from __future__ import annotations

import os
import random
import shutil
import stat
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from minirt.kernel.machine_code import cache_folder, container, private_files
from minirt.kernel.machine_code.code_cache import CodeCache
from minirt.kernel.machine_code.library import Library
from tests.kernel.machine_code.small_kernels import call, double, file_of, is_found, object_code_of, square
from tests.killed import kill_at_each_line

STRANGER = 54321  # a user that no machine has

needs_root = pytest.mark.skipif(
    sys.platform == "win32" or os.geteuid() != 0, reason="needs root, to give files to another user: sudo make test"
)
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are neither owners nor signals of this sort")


@pytest.fixture(autouse=True)
def fresh_notices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test see its notices as if none had been given before."""
    monkeypatch.setattr(cache_folder, "TOLD", set())


def damages(good: bytes, other: bytes) -> Iterator[bytes]:
    """Yield 120 damaged files: cut off, bits flipped, parts zeroed, doubled, or of another kernel."""
    chance = random.Random(1)
    yield from (good[:length] for length in (0, 1, 2, 3, 4, 8, 16, 32, 40, 48, 64, len(good) - 1))
    yield from (good[: chance.randrange(len(good))] for _ in range(18))
    for _ in range(60):
        at = chance.randrange(len(good))
        yield good[:at] + bytes([good[at] ^ 1 << chance.randrange(8)]) + good[at + 1 :]
    for _ in range(20):
        at, length = chance.randrange(len(good) - 1), chance.randint(1, 4096)
        hole = bytes(len(good[at : at + length]))
        yield good[:at] + (hole if any(good[at : at + length]) else b"\1") + good[at + length :]
    yield from (good[: (at := chance.randrange(8, len(good)))] + good[at - 7 :] for _ in range(8))
    yield from (other, good + good, b"\0" + good)[:2]


def test_120_damaged_files_each_end_in_the_right_result(tmp_path: Path) -> None:
    is_found(double, tmp_path), is_found(square, tmp_path)
    path = file_of(double, tmp_path)
    good, tried = path.read_bytes(), 0
    for damaged in damages(good, file_of(square, tmp_path).read_bytes()):
        assert damaged != good
        path.write_bytes(damaged)
        assert not is_found(double, tmp_path), "a damaged kernel was used"
        assert is_found(double, tmp_path), "the damage was not healed"
        tried += 1
    assert tried == 120


def test_without_a_digest_a_damaged_file_would_be_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(container, "digest", lambda *_: bytes(32))
    is_found(double, tmp_path)
    path = file_of(double, tmp_path)
    data = path.read_bytes()
    path.write_bytes(data[:-1] + bytes([data[-1] ^ 1]))
    assert is_found(double, tmp_path)


def plant(folder: Path, owner: int) -> None:
    """Plant a folder of kernels with a valid key, in which `double` squares; it belongs to another user."""
    folder.mkdir(mode=0o777, parents=True)
    folder.chmod(0o777)
    cache = CodeCache(folder)
    name, _ = call(double)
    squaring = object_code_of(call(square)[0], '[{"array": "<f8", "ndim": 1}]')
    assert name
    cache.write(Library().identity(call(double)), squaring)
    for each in (folder.parent, folder, *folder.iterdir()):
        os.chown(each, owner, owner)


@needs_root
def test_kernels_of_another_user_are_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = tmp_path / "minirt" / f"kernels-{cache_folder.fingerprint()}"
    plant(folder, STRANGER)
    assert cache_folder.folder() is None
    assert "belongs to another user" in caplog.messages[0]
    assert not is_found(double, folder), "a kernel that another user wrote was used"


@needs_root
def test_without_the_check_of_owners_the_planted_kernel_would_be_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(private_files, "require_own", lambda *_: None)
    plant(tmp_path / "minirt" / "kernels", STRANGER)
    with pytest.raises(AssertionError):  # it squares
        is_found(double, tmp_path / "minirt" / "kernels")


@needs_root
@pytest.mark.parametrize("level", ["minirt", "kernels"])
def test_a_link_of_another_user_closes_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, level: str
) -> None:
    """As when somebody's cache folder is passed to root by `sudo -E`, and a link in it leads to a folder of root."""
    mine, cache = tmp_path / "mine", tmp_path / "cache"
    for each in (mine, cache):
        each.mkdir(mode=0o755)
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    link = cache / "minirt"
    if level == "kernels":
        link.mkdir(mode=0o700)
        link /= f"kernels-{cache_folder.fingerprint()}"
    link.symlink_to(mine)
    os.chown(link, STRANGER, STRANGER, follow_symlinks=False)
    assert cache_folder.folder() is None
    assert "link of another user" in caplog.messages[0]
    assert stat.S_IMODE(mine.stat().st_mode) == 0o755
    assert list(mine.iterdir()) == []


def test_ones_own_link_may_lead_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "large disk").mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "cache").mkdir()
    (tmp_path / "cache" / "minirt").symlink_to(tmp_path / "large disk")
    folder = cache_folder.folder()
    assert folder is not None
    assert not is_found(double, folder)
    assert is_found(double, folder)


def test_a_folder_that_is_deleted_while_a_program_uses_it_costs_one_notice(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    assert not is_found(double, folder)
    shutil.rmtree(folder)
    assert not is_found(square, folder)
    assert not is_found(double, folder)
    assert len(caplog.messages) == 1


def test_a_program_that_is_killed_while_it_keeps_a_kernel_harms_no_other(tmp_path: Path) -> None:
    identity = Library().identity(call(double))
    code = object_code_of(call(double)[0], '[{"array": "<f8", "ndim": 1}]')
    work: Callable[[], None] = lambda: CodeCache(tmp_path).write(identity, code)  # noqa: E731
    outcomes = set()
    for _ in kill_at_each_line(work, ("file_io", "private_files", "code_cache", "container")):
        names = {path.name for path in tmp_path.iterdir() if not path.name.endswith((".lock", ".tmp"))}
        assert names <= {"key", file_of(double, tmp_path).name}
        outcomes.add(is_found(double, tmp_path))
        for each in tmp_path.iterdir():
            each.unlink()
    assert outcomes == {False, True}
