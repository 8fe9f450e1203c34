"""Folder of compiled kernels: the next process finds them, and other sources never use them."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from minirt.kernel.machine_code import cache_folder
from minirt.kernel.machine_code.processor import processor
from tests.kernel.machine_code.package_copies import copy_package, replace_once
from tests.paths import PACKAGE
from tests.processes import run

NOW = 1.7e9  # any time in the past
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"
RENDER = """
import minirt
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import LIBRARY

compiled = []

def count(process, requests, compile=CompileProcess.compile):
    compiled.extend(requests)
    return compile(process, requests)

CompileProcess.compile = count
scene = minirt.load("ball.rt")
minirt.renderer(None).prepare(scene)  # compiles all kernels in one process
image = minirt.render(scene, 8, 8)
print(LIBRARY.cache and LIBRARY.cache.folder.name, len(LIBRARY.entries) - len(compiled), len(compiled),
      image.array[4, 4].tolist())
"""
KERNELS = "3"  # that of the frame and two functions of binning


def render_in_new_process(folder: Path, cache: Path, notice: str = "") -> list[str]:
    """Render by the package in `folder`, with its kernels under `cache`. Standard error must begin with `notice`.

    Return the name of the folder of kernels, how many kernels were loaded and compiled, and a pixel.
    """
    (folder / "ball.rt").write_text(SCENE)
    variables = {"XDG_CACHE_HOME": str(cache), "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-W", "error", "-c", RENDER]
    ended = run(command, cwd=folder, env=os.environ | variables, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr.startswith(notice)
    assert len(ended.stderr.splitlines()) == bool(notice)
    fields: list[str] = ended.stdout.strip().split(" ", 3)
    return fields


def fingerprint() -> str:
    """Return the fingerprint of the sources as they are now, as a new process does."""
    return cache_folder.fingerprint_of.__wrapped__(processor())


def modification_times(folder: Path) -> dict[str, int]:
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a copy of the package that may be edited."""
    return copy_package(tmp_path_factory.mktemp("copy")).parent


def test_the_next_process_loads_the_kernel_and_edited_sources_compile_it_anew(copy: Path, tmp_path: Path) -> None:
    name, loaded, compiled, pixel = render_in_new_process(copy, tmp_path)
    assert (loaded, compiled, pixel) == ("0", KERNELS, "[10, 20, 30]")
    kept = modification_times(tmp_path)
    assert sum(path.endswith(".kernel") for path in kept) == int(KERNELS)
    assert render_in_new_process(copy, tmp_path) == [name, KERNELS, "0", pixel]
    assert modification_times(tmp_path) == kept

    shade = copy / "minirt" / "kernel" / "shading" / "surfaces.py"
    source = shade.read_text()
    replace_once(shade, "light.y * colour.y", "2.0 * light.y * colour.y")
    edited, loaded, compiled, pixel = render_in_new_process(copy, tmp_path)
    assert edited != name
    assert (loaded, compiled, pixel) == ("0", KERNELS, "[10, 40, 30]")
    shade.write_text(source)
    assert render_in_new_process(copy, tmp_path) == [name, KERNELS, "0", "[10, 20, 30]"]


@pytest.mark.parametrize("source", ["kernel/frame.py", "lanes/vec.py", "shapes/quadric.py", "shapes/new.py"])
def test_each_source_of_a_kernel_changes_the_fingerprint(
    copy: Path, monkeypatch: pytest.MonkeyPatch, source: str, tmp_path: Path
) -> None:
    package = shutil.copytree(copy / "minirt", tmp_path / "minirt")
    monkeypatch.setattr(cache_folder, "PACKAGE", package)
    before = fingerprint()
    assert fingerprint() == before
    with (package / source).open("a") as file:
        file.write("\n")
    assert fingerprint() != before


def test_other_sources_do_not_change_the_fingerprint(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    before = fingerprint()
    package = shutil.copytree(PACKAGE, tmp_path / "elsewhere", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(cache_folder, "PACKAGE", package)
    (package / "cli/__init__.py").write_text("")
    assert fingerprint() == before


def test_old_folders_are_deleted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    parent = tmp_path / "minirt"
    for age in range(cache_folder.OTHER_VERSIONS + 5):
        old = parent / f"kernels-{age}"
        old.mkdir(parents=True)
        (old / "file").touch()
        os.utime(old, (NOW - 1000 * (age + 1),) * 2)
    (parent / "other").mkdir()
    current = cache_folder.folder()
    assert current is not None
    kept = {path.name for path in parent.iterdir()}
    assert kept == {current.name, "other", *(f"kernels-{age}" for age in range(cache_folder.OTHER_VERSIONS))}


def test_the_folder_in_use_is_not_deleted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    current = cache_folder.folder()
    assert current is not None
    os.utime(current, (0, 0))
    for age in range(cache_folder.OTHER_VERSIONS + 1):
        (current.parent / f"kernels-{age}").mkdir()
    assert cache_folder.folder() == current
    assert current.exists()


def test_a_folder_that_is_used_again_is_the_last_to_be_deleted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    used = cache_folder.folder()
    assert used is not None
    for age in range(cache_folder.OTHER_VERSIONS):
        other = used.parent / f"kernels-{age}"
        other.mkdir()
        os.utime(other, (NOW + age, NOW + age))
    os.utime(used, (NOW - 1, NOW - 1))
    assert cache_folder.folder() == used
    cache_folder.delete_old_folders(used.parent / "kernels-of-other-sources")
    assert sorted(path.name for path in used.parent.iterdir()) == sorted(
        [used.name, *(f"kernels-{age}" for age in range(1, cache_folder.OTHER_VERSIONS))]
    )


def test_without_a_writable_folder_the_picture_is_the_same_with_a_notice(copy: Path, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.touch()
    printed = render_in_new_process(copy, blocked, "notice: every run compiles anew")
    assert printed == ["None", "0", KERNELS, "[10, 20, 30]"]


def test_a_relative_cache_folder_is_ignored(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The XDG Base Directory Specification asks to ignore relative paths."""
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    default = cache_folder.user_folder()
    for relative in ("", "cache", "./cache", "../cache"):
        monkeypatch.setenv("XDG_CACHE_HOME", relative)
        assert cache_folder.user_folder() == default
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder.user_folder() == tmp_path


@pytest.mark.skipif(sys.platform == "win32", reason="folders have no modes there")
@pytest.mark.parametrize("name", [".", "kernels"])
def test_nothing_is_kept_in_a_folder_that_others_may_write(copy: Path, tmp_path: Path, name: str) -> None:
    """Neither in minirt nor in the folder of kernels in it."""
    first = render_in_new_process(copy, tmp_path)
    unsafe = tmp_path / "minirt" / (first[0] if name == "kernels" else name)
    unsafe.chmod(0o777)
    kept = modification_times(tmp_path)
    printed = render_in_new_process(copy, tmp_path, "notice: every run compiles anew, kernels cannot be kept: other")
    assert printed == ["None", "0", KERNELS, "[10, 20, 30]"]
    assert modification_times(tmp_path) == kept
    unsafe.chmod(0o700)
    assert render_in_new_process(copy, tmp_path) == [first[0], KERNELS, "0", "[10, 20, 30]"]


def test_nothing_is_kept_in_a_folder_of_another_user(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(cache_folder, "TOLD", set())
    assert cache_folder.folder() is not None
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    assert cache_folder.folder() is None
    assert cache_folder.folder() is None
    (told,) = caplog.messages
    assert "belongs to another user" in told
