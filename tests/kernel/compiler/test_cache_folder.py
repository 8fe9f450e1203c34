"""Compiled kernels are kept: found by the next process, and never used for other sources."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from minirt.kernel.compiler import cache_folder
from tests.kernel.compiler.copies import copied, replace
from tests.paths import PACKAGE
from tests.processes import run

NOW = 1.7e9  # any time in the past
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"
RENDER = """
import minirt
from minirt.kernel import jit
from minirt.rendering.scene_packing import Packing
scene = minirt.load("ball.rt")
image = minirt.render(scene, 8, 8)
stats = jit.kernel_for(Packing().pack(scene, 8, 8)).stats
print(jit.CACHE and jit.CACHE.name, sum(stats.cache_hits.values()),
      sum(stats.cache_misses.values()), image.array[4, 4].tolist())
"""


def process(folder: Path, place: Path, told: str = "") -> list[str]:
    """What a new process prints that imports the package in `folder` and keeps its kernels under `place`: the folder,
    how often the kernel was found and not, a pixel. `told` is how what it says on standard error begins."""
    (folder / "ball.rt").write_text(SCENE)
    places = {"XDG_CACHE_HOME": str(place), "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-W", "error", "-c", RENDER]
    done = run(command, cwd=folder, env=os.environ | places, text=True)
    assert done.returncode == 0
    assert done.stderr.startswith(told)
    assert len(done.stderr.splitlines()) == bool(told)
    return done.stdout.strip().split(" ", 3)


def files(place: Path) -> dict[str, int]:
    return {str(path.relative_to(place)): path.stat().st_mtime_ns for path in place.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package that may be edited."""
    return copied(tmp_path_factory.mktemp("copy")).parent


def test_the_next_process_finds_the_kernel_and_edited_sources_do_not(copy: Path, tmp_path: Path) -> None:
    name, hits, misses, pixel = process(copy, tmp_path)
    assert (hits, misses, pixel) == ("0", "1", "[10, 20, 30]")
    kept = files(tmp_path)
    assert len(kept) == 6  # index and machine code of the kernel and of the two that make the lists
    assert process(copy, tmp_path) == [name, "1", "0", pixel]
    assert files(tmp_path) == kept

    shade = copy / "minirt" / "kernel" / "shading" / "shade.py"
    source = shade.read_text()
    replace(shade, "light.y * colour.y", "2.0 * light.y * colour.y")
    edited, hits, misses, pixel = process(copy, tmp_path)
    assert edited != name
    assert (hits, misses, pixel) == ("0", "1", "[10, 40, 30]")
    shade.write_text(source)
    assert process(copy, tmp_path) == [name, "1", "0", "[10, 20, 30]"]


@pytest.mark.parametrize("source", ["kernel/frame.py", "lanes/vec.py", "shapes/quadric.py", "shapes/new.py"])
def test_each_source_of_a_kernel_counts(
    copy: Path, monkeypatch: pytest.MonkeyPatch, source: str, tmp_path: Path
) -> None:
    package = shutil.copytree(copy / "minirt", tmp_path / "minirt")
    monkeypatch.setattr(cache_folder, "PACKAGE", package)
    before = cache_folder.fingerprint()
    assert cache_folder.fingerprint() == before
    with (package / source).open("a") as file:
        file.write("\n")
    assert cache_folder.fingerprint() != before


def test_other_sources_and_other_places_do_not_count(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    before = cache_folder.fingerprint()
    package = shutil.copytree(PACKAGE, tmp_path / "elsewhere", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(cache_folder, "PACKAGE", package)
    (package / "cli/__init__.py").write_text("")
    assert cache_folder.fingerprint() == before


def test_old_folders_are_deleted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    parent = tmp_path / "minirt"
    for age in range(cache_folder.KEPT + 5):
        old = parent / f"kernels-{age}"
        old.mkdir(parents=True)
        (old / "file").touch()
        os.utime(old, (NOW - 1000 * (age + 1),) * 2)
    (parent / "other").mkdir()
    place = cache_folder.folder()
    assert place is not None
    kept = {path.name for path in parent.iterdir()}
    assert kept == {place.name, "other", *(f"kernels-{age}" for age in range(cache_folder.KEPT))}


def test_the_folder_in_use_stays(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    place = cache_folder.folder()
    assert place is not None
    os.utime(place, (0, 0))
    for age in range(cache_folder.KEPT + 1):
        (place.parent / f"kernels-{age}").mkdir()
    assert cache_folder.folder() == place
    assert place.exists()


def test_without_a_place_to_write_there_is_a_picture_all_the_same(copy: Path, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.touch()
    assert process(copy, blocked, "notice: every run compiles anew") == ["None", "0", "1", "[10, 20, 30]"]


def test_numbas_own_setting_is_left_alone(tmp_path: Path) -> None:
    from numba.core import config

    before = config.CACHE_DIR
    with cache_folder.numba_cache(tmp_path):
        assert str(tmp_path) == config.CACHE_DIR
    assert before == config.CACHE_DIR
