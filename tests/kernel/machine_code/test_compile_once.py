"""Programs that need the same kernel at once compile it once: the others wait and load it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from minirt.kernel.machine_code.private_files import locked
from tests.kernel.machine_code.package_copies import copy_package
from tests.kernel.machine_code.small_kernels import double, file_of, is_found
from tests.kernel.machine_code.test_cache_folder import KERNELS, render_in_new_process
from tests.lines import next_line
from tests.paths import ROOT
from tests.processes import started
from tests.waiting import HANG_LIMIT

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="files cannot be locked there")

PROGRAMS = 4
WAITING = """
import sys
from pathlib import Path
from minirt.kernel.machine_code import private_files
from tests.kernel.machine_code.small_kernels import double, is_found

def wait(descriptor, lock=private_files.wait_for_lock):
    print("waiting", flush=True)
    lock(descriptor)

private_files.wait_for_lock = wait
print(is_found(double, Path(sys.argv[1])))
"""


WITHOUT_LOCK = """
from contextlib import nullcontext
from minirt.kernel.machine_code.code_cache import CodeCache
CodeCache.compiling_once = lambda *_: nullcontext()
"""


def output_of_a_second_program(tmp_path: Path, program: str) -> list[str]:
    """Start a program while a first one, which is this one, compiles; the first ends when the second waits for it.

    Return the lines that the second program prints."""
    folder, other = tmp_path / "folder", tmp_path / "other"
    for each in (folder, other):
        each.mkdir(mode=0o700)
    assert not is_found(double, other)
    kernel = file_of(double, folder)
    shutil.copyfile(other / "key", folder / "key")
    (folder / "key").chmod(0o600)
    command = [sys.executable, "-c", program, str(folder)]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with started(command, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True) as second:
        with locked(kernel.with_suffix(".lock")):
            first_line = next_line(second)
            shutil.copy(other / kernel.name, kernel)
        return [first_line, *second.communicate(timeout=HANG_LIMIT)[0].split()]


def test_a_program_waits_for_another_that_compiles_the_same_kernel(tmp_path: Path) -> None:
    assert output_of_a_second_program(tmp_path, WAITING) == ["waiting", "True"]


def test_a_program_that_does_not_wait_would_be_found_here(tmp_path: Path) -> None:
    assert output_of_a_second_program(tmp_path, WITHOUT_LOCK + WAITING) == ["False"]


def test_programs_that_start_at_once_compile_once(tmp_path: Path) -> None:
    package, cache = copy_package(tmp_path).parent, tmp_path / "cache"
    with ThreadPoolExecutor(PROGRAMS) as pool:
        printed = list(pool.map(lambda _: render_in_new_process(package, cache), range(PROGRAMS)))
    assert {each[3] for each in printed} == {"[10, 20, 30]"}
    assert sum(int(compiled) for _, _, compiled, _ in printed) == int(KERNELS)
    assert sum(int(loaded) for _, loaded, _, _ in printed) == (PROGRAMS - 1) * int(KERNELS)
    kept = [path for path in cache.rglob("*") if path.is_file() and path.suffix != ".lock"]
    assert sorted(path.suffix for path in kept) == ["", *[".kernel"] * int(KERNELS)], "more than kernels and a key"
