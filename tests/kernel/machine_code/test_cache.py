"""Cache of kernels: damaged files heal, and folders of others, other sources and other processors are not used."""

from __future__ import annotations

import errno
import os
import platform
import random
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from llvmlite import binding

from minirt.kernel.machine_code import cache, fingerprint
from minirt.kernel.machine_code.cache import CodeCache
from minirt.kernel.machine_code.fingerprint import NATIVE, NEEDED, V3, V4, described, level_of, processor
from tests.kernel.machine_code.small_kernels import double, file_of, is_found, square
from tests.paths import PACKAGE
from tests.processes import fork

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="there are neither owners nor modes, nor locks")
NOW = 1.7e9  # any time in the past


@pytest.fixture(autouse=True)
def fresh_notices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test see its notices as if none had been given before."""
    monkeypatch.setattr(cache, "TOLD", set())


def damages(good: bytes, other: bytes) -> Iterator[bytes]:
    """Yield damaged files: cut off, bits flipped, longer, empty, or of another kernel."""
    chance = random.Random(1)
    yield from (good[:length] for length in (0, 1, 16, 24, len(good) // 2, len(good) - 1))
    for at in (0, 15, 16, len(good) - 1, *(chance.randrange(len(good)) for _ in range(8))):
        yield good[:at] + bytes([good[at] ^ 1 << chance.randrange(8)]) + good[at + 1 :]
    yield from (other, good + good, bytes(len(good)))


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


@POSIX
@pytest.mark.parametrize("bits", [0o755, 0o720, 0o702])
@pytest.mark.parametrize("depth", [0, 1])
def test_the_folder_is_made_private_and_not_used_where_others_may_write_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, bits: int, depth: int
) -> None:
    """The same holds for the folder minirt, in which it is."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = cache.folder()
    assert folder
    assert [each.stat().st_mode & 0o777 for each in (folder, folder.parent)] == [0o700] * 2
    changed = (folder, folder.parent)[depth]
    changed.chmod(bits)
    if bits == 0o755:
        assert cache.folder() == folder
    else:
        assert cache.folder() is cache.folder() is None
        (told,) = caplog.messages
        assert told.endswith(f"other users may write {changed}; chmod go-w '{changed}' mends that")
        assert changed.stat().st_mode & 0o777 == bits, "what others may have put there stays out of use"


@pytest.mark.parametrize("fault", ["file", "read only", pytest.param("owner", marks=POSIX)])
def test_without_a_folder_of_the_user_nothing_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, fault: str
) -> None:
    """A file has the name of the folder, the disk is read only, or the folder belongs to another user."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    if fault == "file":
        (tmp_path / "minirt").touch()
    elif fault == "owner":
        user = os.geteuid()
        monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    else:
        monkeypatch.setattr(os, "utime", failing(errno.EROFS))
    assert cache.folder() is None
    assert ("belongs to another user" in caplog.messages[0]) == (fault == "owner")


def test_the_folders_that_were_used_last_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
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


@POSIX
@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
def test_a_lock_is_free_although_a_forked_process_has_its_file_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that is held for too long is passed over."""
    folder, path = CodeCache(tmp_path), CodeCache(tmp_path).file_of("a kernel").with_suffix(".lock")
    monkeypatch.setattr(cache, "PATIENCE", 0.0)

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


# The fingerprint: the level of the processor, and all sources of a kernel in a fixed order.


ALL_FLAGS = NEEDED[V3] | NEEDED[V4] | {"sse4_2", "popcnt", "avx512vnni"}
LLVM_NAMES = {"bmi1": "bmi", "abm": "lzcnt"}  # where LLVM has another name than Linux


@pytest.fixture(autouse=True)
def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test find out the level anew, without a setting of the environment."""
    monkeypatch.setenv("NUMBA_CPU_NAME", "")
    monkeypatch.setattr(fingerprint, "level", fingerprint.level.__wrapped__)


def test_the_highest_level_whose_flags_are_all_there_is_chosen() -> None:
    assert level_of(ALL_FLAGS) == V4
    assert level_of(NEEDED[V3]) == V3
    assert {level_of(ALL_FLAGS - {flag}) for flag in NEEDED[V3]} == {level_of(set())} == {NATIVE}
    assert {level_of(ALL_FLAGS - {flag}) for flag in NEEDED[V4]} == {V3}


@pytest.mark.skipif(not fingerprint.is_linux_on_x86_64(), reason="levels are of x86-64, flags from Linux")
def test_the_level_of_this_machine_is_that_which_llvm_sees() -> None:
    """Misspelt, a flag would never be found, and every machine would compile at first use."""
    features = binding.get_host_cpu_features()
    seen = {flag for flag in NEEDED[V3] | NEEDED[V4] if features[LLVM_NAMES.get(flag, flag)]}
    assert processor() == level_of(seen)


@pytest.mark.parametrize(
    ("system", "machine", "expected"),
    [("linux", "x86_64", V4), ("linux", "aarch64", NATIVE), ("darwin", "x86_64", NATIVE), ("win32", "AMD64", NATIVE)],
)
def test_only_linux_on_x86_64_has_levels(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, system: str, machine: str, expected: str
) -> None:
    """Code for the very processor is of use on its model alone. The environment may name another processor."""
    flags, cpuinfo = " ".join(sorted(ALL_FLAGS)), tmp_path / "cpuinfo"
    cpuinfo.write_bytes(f"model name\t: Old: fast\nflags\t\t: {flags} ".encode() + b"\xff\n\nflags\t\t: none\n")
    monkeypatch.setattr(fingerprint, "CPUINFO", cpuinfo)
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    assert processor() == expected
    assert ("Old: fast" in described(processor())) == (expected == NATIVE)
    assert described(V3).split() == [system, V3]
    cpuinfo.unlink()
    assert processor() == NATIVE
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert processor() == "generic"


@pytest.mark.parametrize("name", ["kernel/frame.py", "kernel/shading/new.py", "lanes/mathematics.py"])
def test_each_source_of_a_kernel_changes_the_fingerprint_and_nothing_else(
    monkeypatch: pytest.MonkeyPatch, name: str, tmp_path: Path
) -> None:
    """Not the order of the disk either."""

    def found() -> str:
        return fingerprint.fingerprint_of.__wrapped__(V3)

    def backwards(top: Any) -> Iterator[Any]:
        for parent, folders, names in walk(top):
            folders.reverse()
            yield parent, folders, names[::-1]

    before, walk = found(), os.walk
    package = shutil.copytree(PACKAGE, tmp_path / "minirt", ignore=shutil.ignore_patterns("__pycache__", "*.kernel"))
    monkeypatch.setattr(fingerprint, "PACKAGE", package)
    monkeypatch.setattr(os, "walk", backwards)
    (package / "cli/__init__.py").write_text("")
    (package / "shapes/page.md").touch()
    assert found() == before
    with (package / name).open("a") as file:
        file.write("\n")
    assert found() != before
