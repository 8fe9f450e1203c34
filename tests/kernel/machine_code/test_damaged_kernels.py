"""Kernels on disk that are damaged, foreign or hostile are never used: they are compiled anew, with one notice."""

from __future__ import annotations

import os
import pickle
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.kernel.machine_code import cache_folder, container, private_files
from tests.kernel.machine_code.package_copies import copy_package
from tests.kernel.machine_code.small_kernels import double, file_of, is_found, square
from tests.kernel.machine_code.test_cache_folder import KERNELS, render_in_new_process

NOTICE = "is deleted and compiled anew"


class Hostile:
    """Makes a file when it is unpickled."""

    def __init__(self, marker: Path) -> None:
        self.marker = marker

    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (self.marker,)


def truncate(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def empty(path: Path) -> None:
    os.truncate(path, 0)


def flip_a_bit_of_the_code(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[-50] ^= 1
    path.write_bytes(data)


def append(path: Path) -> None:
    path.write_bytes(path.read_bytes() + b"\0")


def take_the_file_of_another_kernel(path: Path) -> None:
    shutil.copyfile(file_of(square, path.parent), path)


def take_another_format(path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(container, "VERSION", container.VERSION + 1)
        key = (path.parent / "key").read_bytes()
        path.write_bytes(container.pack(key, "", {}, b""))


def plant_a_pickle(path: Path) -> None:
    path.write_bytes(pickle.dumps(Hostile(path.parent / "marker")))


def let_others_write(path: Path) -> None:
    path.chmod(0o666)


def change_the_key(path: Path) -> None:
    (path.parent / "key").write_bytes(bytes(32))


def lose_the_key(path: Path) -> None:
    (path.parent / "key").unlink()


def put_a_pipe_in_its_place(path: Path) -> None:
    path.unlink()
    os.mkfifo(path, 0o600)


DAMAGES = [
    truncate,
    empty,
    flip_a_bit_of_the_code,
    append,
    take_the_file_of_another_kernel,
    take_another_format,
    plant_a_pickle,
    change_the_key,
    lose_the_key,
]
POSIX_DAMAGES = [let_others_write, put_a_pipe_in_its_place]
if sys.platform != "win32":
    DAMAGES += POSIX_DAMAGES


@pytest.fixture
def notices(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> list[str]:
    """The notices of a test, as if none had been given before."""
    monkeypatch.setattr(cache_folder, "TOLD", set())
    return caplog.messages


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Folder with both small kernels."""
    for function in (double, square):
        assert not is_found(function, tmp_path)
        assert is_found(function, tmp_path)
    return tmp_path


def heals(damage: Callable[[Path], None], folder: Path, caplog: pytest.LogCaptureFixture) -> bool:
    """Whether a damaged kernel is compiled anew with one notice, and then found again."""
    path = file_of(double, folder)
    damage(path)
    was_found = is_found(double, folder)
    told = list(caplog.messages)
    return not was_found and len(told) == 1 and NOTICE in told[0] and is_found(double, folder)


@pytest.mark.usefixtures("notices")
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_kernel_is_compiled_anew(
    damage: Callable[[Path], None], folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert heals(damage, folder, caplog)
    assert not (folder / "marker").exists()
    is_found(square, folder)
    assert len(caplog.messages) == 1, "further damages are healed in silence"


@pytest.mark.usefixtures("notices")
def test_without_the_identity_in_the_digest_a_swapped_kernel_would_be_found_here(
    folder: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    digest = container.digest
    monkeypatch.setattr(container, "digest", lambda key, identity, content: digest(key, "", content))
    for path in folder.glob("*.kernel"):
        path.unlink()
    is_found(square, folder)
    is_found(double, folder)
    with pytest.raises(AssertionError):  # the kernel squares instead of doubling
        heals(take_the_file_of_another_kernel, folder, caplog)


@pytest.mark.skipif(sys.platform == "win32", reason="files have no modes there")
@pytest.mark.usefixtures("notices")
def test_without_the_check_of_modes_a_file_that_others_may_write_would_be_found_here(
    folder: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(private_files, "require_own", lambda *_: None)
    assert not heals(let_others_write, folder, caplog)


def test_the_planted_pickle_makes_a_file_where_it_is_unpickled(tmp_path: Path) -> None:
    plant_a_pickle(tmp_path / "file")
    pickle.loads((tmp_path / "file").read_bytes())
    assert (tmp_path / "marker").exists()


def test_nothing_in_the_cache_is_unpickled(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("something was unpickled")

    for name in ("load", "loads", "Unpickler"):
        monkeypatch.setattr(pickle, name, refuse)
    assert is_found(double, folder)


def test_pictures_are_right_whatever_is_in_the_files_of_kernels(tmp_path: Path) -> None:
    package, cache = copy_package(tmp_path).parent, tmp_path / "cache"
    name, *_, pixel = render_in_new_process(package, cache)
    kernels = sorted((cache / "minirt" / name).glob("*.kernel"))
    for path, damage in zip(kernels, (truncate, flip_a_bit_of_the_code, plant_a_pickle), strict=True):
        damage(path)
    assert render_in_new_process(package, cache, "notice: a kernel in ") == [name, "0", KERNELS, pixel]
    assert render_in_new_process(package, cache) == [name, KERNELS, "0", pixel]
    assert not (cache / "minirt" / name / "marker").exists()
