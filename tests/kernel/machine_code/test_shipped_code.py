"""Kernels that came with the package: used without compiling where all fits, ignored without a word elsewhere."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from minirt.kernel.machine_code import cache_folder, container, shipped_code
from minirt.kernel.machine_code.code_cache import file_name
from minirt.kernel.machine_code.processor import processor
from tests.kernel.machine_code.package_copies import copy_package, replace_once
from tests.kernel.machine_code.small_kernels import Compiler, call, compiled, double, library, object_code_of, square
from tests.kernel.machine_code.test_cache_folder import KERNELS, SCENE, modification_times, render_in_new_process
from tests.kernel.machine_code.test_signature import through_json
from tests.processes import run

SHIP = """
import minirt
from minirt.kernel.machine_code import shipped_code
from minirt.kernel.machine_code.library import LIBRARY
from minirt.kernel.machine_code.processor import processor

scene = minirt.load("ball.rt")
minirt.renderer(None).prepare(scene)
for identity in LIBRARY.entries:
    shipped_code.write(identity, LIBRARY.cache.read(identity), shipped_code.FOLDER / processor())
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of the kernels that came with the package, for this processor: none."""
    monkeypatch.setattr(shipped_code, "FOLDER", tmp_path / "shipped")
    return tmp_path / "shipped" / processor()


def ship(function: Callable[..., None], fingerprint: str | None = None, name: str | None = None) -> Path:
    """Add a small kernel to the package, for these sources or others and for a processor; return its path."""
    function_name, values = call(function)
    signatures = [through_json(each) for each in values]
    identity = json.dumps([function_name, signatures, fingerprint or cache_folder.fingerprint()])
    folder = shipped_code.FOLDER / (name or processor())
    shipped_code.write(identity, object_code_of(function_name, json.dumps(signatures)), folder)
    return folder / file_name(identity)


def is_used(caplog: pytest.LogCaptureFixture) -> bool:
    """Whether the small kernel of the package is found; if it is not, it is compiled without a word. It is right."""
    compiler, values = Compiler(), np.array([1.5])
    compiled(library(None), call(double), compiler)(values)
    assert values == [3.0]
    assert caplog.messages == []
    return not compiler.compiled


def test_a_kernel_of_the_package_is_used(caplog: pytest.LogCaptureFixture) -> None:
    assert not is_used(caplog)
    ship(double)
    assert is_used(caplog)


def test_a_kernel_for_other_sources_or_another_processor_is_ignored(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    ship(double, "other sources")
    ship(double, cache_folder.fingerprint_of("another-processor"), "another-processor")
    assert not is_used(caplog)
    ship(double)
    assert is_used(caplog)
    monkeypatch.setenv("NUMBA_CPU_NAME", "another-processor")
    assert is_used(caplog)  # as that processor now counts as this one
    monkeypatch.setenv("NUMBA_CPU_NAME", "a-third-processor")
    assert not is_used(caplog)


def test_a_kernel_in_the_folder_of_another_processor_is_ignored(caplog: pytest.LogCaptureFixture) -> None:
    ship(double, cache_folder.fingerprint_of("another-processor"))
    ship(double, None, "another-processor")
    assert not is_used(caplog)


def test_kernels_of_older_sources_are_deleted(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    old, new = ship(double, "older sources"), ship(double)
    (folder / "README").touch()
    kernels = library(None)
    shipped_code.delete_others([kernels.identity(call(each)) for each in (double, square)], folder)
    assert set(folder.iterdir()) == {new, folder / "README"} == {*folder.iterdir()} - {old}
    assert is_used(caplog)


@pytest.mark.skipif(sys.platform == "win32", reason="files have no modes there")
def test_all_users_of_an_installed_package_may_read_its_kernels() -> None:
    assert ship(double).stat().st_mode & 0o777 == 0o644


def test_a_kernel_in_the_place_of_another_one_is_ignored(caplog: pytest.LogCaptureFixture) -> None:
    path = ship(double)
    path.write_bytes(ship(square).read_bytes())
    assert not is_used(caplog)


def test_damage_anywhere_is_noticed_and_ignored(caplog: pytest.LogCaptureFixture) -> None:
    path = ship(double)
    good = path.read_bytes()
    for damaged in (b"", good[:20], good[:-1], good + b"\0", bytes(len(good))):
        path.write_bytes(damaged)
        assert not is_used(caplog)
    for place in (0, 9, container.HEADER.size - 1, container.HEADER.size, len(good) // 2, len(good) - 1):
        path.write_bytes(good[:place] + bytes([good[place] ^ 1]) + good[place + 1 :])
        assert not is_used(caplog)
    path.unlink()
    path.mkdir()
    assert not is_used(caplog)
    path.rmdir()
    path.write_bytes(good)
    assert is_used(caplog)


def test_a_package_with_kernels_never_compiles_and_changes_nothing(tmp_path: Path) -> None:
    """In a folder that is only read; then for other sources, and with damaged kernels, without a word."""
    package = copy_package(tmp_path)
    rendered, home = [10, 20, 30], tmp_path / "home"
    (tmp_path / "ball.rt").write_text(SCENE)
    variables = {"XDG_CACHE_HOME": str(home), "PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    ended = run([sys.executable, "-c", SHIP], cwd=tmp_path, env=os.environ | variables, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")
    shipped = package / "kernel" / "ahead_of_time" / processor()
    assert len(list(shipped.iterdir())) == int(KERNELS)
    shutil.rmtree(home)

    folders = [package, *(each for each in package.rglob("*") if each.is_dir())]
    for each in folders:
        each.chmod(0o555)
    before = modification_times(package)
    name, *counts = render_in_new_process(tmp_path, home)
    assert counts == [KERNELS, "0", str(rendered)]
    assert not list(home.rglob("*.kernel")), "what the package has is not kept twice"
    blocked = tmp_path / "file"
    blocked.touch()
    assert render_in_new_process(tmp_path, blocked, "notice: every run compiles anew")[1:] == counts
    assert modification_times(package) == before
    for each in folders:
        each.chmod(0o755)

    for path in shipped.iterdir():
        path.write_bytes(path.read_bytes()[:-1])
    assert render_in_new_process(tmp_path, home) == [name, "0", KERNELS, str(rendered)]
    replace_once(package / "kernel" / "shading" / "surfaces.py", "light.y * colour.y", "2.0 * light.y * colour.y")
    other, *counts = render_in_new_process(tmp_path, home)
    assert other != name
    assert counts == ["0", KERNELS, "[10, 40, 30]"]
