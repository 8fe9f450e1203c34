"""Kernels on disk as programs use them: the next one finds them, and those of other sources or users are never used."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from minirt.kernel.machine_code.fingerprint import processor
from tests.kernel.machine_code.package_copies import copy_package, replace_once
from tests.processes import run

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
FULL_DISK = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))\n"  # every write to a file fails
SHIP = """
from minirt.kernel.machine_code.cache import SHIPPED, CodeCache
from minirt.kernel.machine_code.fingerprint import processor

(SHIPPED / processor()).mkdir(parents=True)
for identity in LIBRARY.entries:
    CodeCache(SHIPPED / processor()).write(identity, LIBRARY.cache.read(identity))
"""
KERNELS = "3"  # that of the frame and two functions of binning
PIXEL = "[10, 20, 30]"
FIRST, SECOND = 54321, 54322  # users that no machine has


def rendered(
    folder: Path, cache: Path, notice: str = "", program: str = RENDER, user: tuple[str, ...] = ()
) -> list[str]:
    """Render by the package in `folder`, with its kernels under `cache`. Standard error must begin with `notice`.

    Return the name of the folder of kernels, how many kernels were loaded and compiled, and a pixel.
    """
    (folder / "ball.rt").write_text(SCENE)
    variables = {"XDG_CACHE_HOME": str(cache), "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [*user, sys.executable, "-W", "error", "-c", program]
    ended = run(command, cwd=folder, env=os.environ | variables | {"HOME": str(folder)}, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr.startswith(notice)
    assert len(ended.stderr.splitlines()) == bool(notice)
    fields: list[str] = ended.stdout.strip().split(" ", 3)
    return fields


def modification_times(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a copy of the package that may be edited."""
    return copy_package(tmp_path_factory.mktemp("copy")).parent


def test_the_next_program_loads_the_kernels_and_edited_sources_compile_them_anew(copy: Path, tmp_path: Path) -> None:
    name, *counts = rendered(copy, tmp_path)
    assert counts == ["0", KERNELS, PIXEL]
    kept = modification_times(tmp_path)
    assert sum(path.suffix == ".kernel" for path in kept) == int(KERNELS)
    assert rendered(copy, tmp_path) == [name, KERNELS, "0", PIXEL]
    assert modification_times(tmp_path) == kept

    shade = copy / "minirt" / "kernel" / "shading" / "surfaces.py"
    source = shade.read_text()
    replace_once(shade, "light.y * colour.y", "2.0 * light.y * colour.y")
    edited, *counts = rendered(copy, tmp_path)
    assert edited != name
    assert counts == ["0", KERNELS, "[10, 40, 30]"]
    shade.write_text(source)
    assert rendered(copy, tmp_path) == [name, KERNELS, "0", PIXEL]


@pytest.mark.skipif(sys.platform == "win32", reason="there are neither modes nor such a limit")
def test_the_picture_is_right_where_nothing_can_be_kept(copy: Path, tmp_path: Path) -> None:
    """Where a file is in the place of the folder, where others may write the folder, and on a full disk."""
    (tmp_path / "file").touch()
    (tmp_path / "open" / "minirt").mkdir(parents=True)
    (tmp_path / "open" / "minirt").chmod(0o777)
    for cache in ("file", "open"):
        printed = rendered(copy, tmp_path / cache, "notice: every run compiles anew, kernels cannot be kept")
        assert printed == ["None", "0", KERNELS, PIXEL]
    notice = "notice: every run compiles anew, a kernel cannot be kept"
    assert rendered(copy, tmp_path / "full", notice, FULL_DISK + RENDER)[1:] == ["0", KERNELS, PIXEL]


@pytest.mark.skipif(sys.platform == "win32", reason="files cannot be locked there")
def test_programs_that_start_at_once_compile_each_kernel_once(copy: Path, tmp_path: Path) -> None:
    with ThreadPoolExecutor(4) as pool:
        printed = list(pool.map(lambda _: rendered(copy, tmp_path), range(4)))
    assert {each[3] for each in printed} == {PIXEL}
    assert sum(int(compiled) for _, _, compiled, _ in printed) == int(KERNELS)
    kept = [path.suffix for path in tmp_path.rglob("*") if path.is_file() and path.suffix != ".lock"]
    assert kept == [".kernel"] * int(KERNELS)


def test_a_package_with_kernels_never_compiles_and_changes_nothing(tmp_path: Path) -> None:
    """In a folder that is only read; then with damaged kernels, and for other sources."""
    package, home = copy_package(tmp_path), tmp_path / "home"
    rendered(tmp_path, home, program=RENDER + SHIP)
    shipped = package / "kernel" / "ahead_of_time" / processor()
    assert len(list(shipped.iterdir())) == int(KERNELS)
    shutil.rmtree(home)

    folders = [package, *(each for each in package.rglob("*") if each.is_dir())]
    for each in folders:
        each.chmod(0o555)
    before = modification_times(package)
    name, *counts = rendered(tmp_path, home)
    assert counts == [KERNELS, "0", PIXEL]
    assert not list(home.rglob("*.kernel")), "what the package has is not kept twice"
    assert modification_times(package) == before
    for each in folders:
        each.chmod(0o755)

    for path in shipped.iterdir():
        path.write_bytes(path.read_bytes()[:-1])
    notice = "notice: a kernel in "
    assert rendered(tmp_path, home, notice) == [name, "0", KERNELS, PIXEL]
    assert rendered(tmp_path, home, notice) == [name, KERNELS, "0", PIXEL]
    replace_once(package / "kernel" / "shading" / "surfaces.py", "light.y * colour.y", "2.0 * light.y * colour.y")
    other, *counts = rendered(tmp_path, home)
    assert other != name
    assert counts == ["0", KERNELS, "[10, 40, 30]"]


def as_user(user: int) -> tuple[str, ...]:
    """Return what runs a command as a user without groups, who lets everybody write his files and may read all."""
    rights = (f"--{kind}-caps=+dac_read_search" for kind in ("inh", "ambient"))
    run_it = ("sh", "-c", 'umask 000; exec "$@"', "sh")
    return "setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups", *rights, *run_it


def can_run_as_others() -> bool:
    """Whether programs can be run as other users, with this interpreter."""
    if sys.platform != "linux" or os.geteuid() or not shutil.which("setpriv"):
        return False
    return run([*as_user(FIRST), sys.executable, "-c", "import numba"], cwd="/").returncode == 0


@pytest.mark.skipif(not can_run_as_others(), reason="needs root, to run programs as others: sudo make test")
def test_a_second_user_compiles_for_himself_and_draws_the_same(copy: Path) -> None:
    with tempfile.TemporaryDirectory() as name:
        shared = Path(name)
        shared.chmod(0o777)
        shutil.copytree(copy / "minirt", shared / "minirt")
        cache = shared / "cache"
        assert rendered(shared, cache, user=as_user(FIRST))[1:] == ["0", KERNELS, PIXEL]
        for path in cache.rglob("*"):
            assert path.stat().st_uid == FIRST
            path.chmod(0o777)  # as if the first user wanted the second one to use it
        kept = modification_times(cache)
        notice = "notice: every run compiles anew, kernels cannot be kept"
        assert rendered(shared, cache, notice, user=as_user(SECOND)) == ["None", "0", KERNELS, PIXEL]
        assert modification_times(cache) == kept
