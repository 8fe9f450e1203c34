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
from tests.kernel.machine_code.package_copies import copy_package, replace_once
from tests.kernel.machine_code.small_kernels import Compiler, call, compiled, double, library, object_code_of, square
from tests.kernel.machine_code.test_cache_folder import KERNELS, SCENE, modification_times, render_in_new_process
from tests.kernel.machine_code.test_signature import through_json
from tests.processes import run

SHIP = """
import sys
from minirt.kernel.machine_code import container, shipped_code
from minirt.kernel.machine_code.code_cache import file_name
from minirt.kernel.machine_code.library import LIBRARY
import minirt

scene = minirt.load("ball.rt")
minirt.renderer(None).prepare(scene)
shipped_code.FOLDER.mkdir()
for identity in LIBRARY.entries:
    data = container.pack(shipped_code.NO_KEY, identity, *LIBRARY.cache.read(identity))
    (shipped_code.FOLDER / file_name(identity)).write_bytes(data)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of kernels that came with the package: none."""
    monkeypatch.setattr(shipped_code, "FOLDER", tmp_path / "shipped")
    return tmp_path / "shipped"


def ship(folder: Path, function: Callable[..., None], fingerprint: str | None = None) -> Path:
    """Put a small kernel into a folder, for these sources or others, and return its path."""
    name, values = call(function)
    signatures = [through_json(each) for each in values]
    identity = json.dumps([name, signatures, fingerprint or cache_folder.fingerprint()])
    path = folder / file_name(identity)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(container.pack(b"", identity, *object_code_of(name, json.dumps(signatures))))
    return path


def is_used(caplog: pytest.LogCaptureFixture) -> bool:
    """Whether the small kernel of the package is found; if it is not, it is compiled without a word. It is right."""
    compiler, values = Compiler(), np.array([1.5])
    compiled(library(None), call(double), compiler)(values)
    assert values == [3.0]
    assert caplog.messages == []
    return not compiler.compiled


def test_a_kernel_of_the_package_is_used(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    assert not is_used(caplog)
    ship(folder, double)
    assert is_used(caplog)


def test_a_kernel_for_other_sources_or_another_processor_is_ignored(
    folder: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    ship(folder, double, "other sources")
    ship(folder, double, cache_folder.fingerprint_of("another processor"))
    assert not is_used(caplog)
    ship(folder, double)
    assert is_used(caplog)
    monkeypatch.setenv("NUMBA_CPU_NAME", "another-processor")
    assert not is_used(caplog)


def test_a_kernel_in_the_place_of_another_one_is_ignored(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = ship(folder, double)
    path.write_bytes(ship(folder, square).read_bytes())
    assert not is_used(caplog)


def test_damage_anywhere_is_noticed_and_ignored(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = ship(folder, double)
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
    shipped = package / "kernel" / "ahead_of_time"
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
    replace_once(package / "kernel" / "shading" / "shade.py", "light.y * colour.y", "2.0 * light.y * colour.y")
    other, *counts = render_in_new_process(tmp_path, home)
    assert other != name
    assert counts == ["0", KERNELS, "[10, 40, 30]"]
