"""Wheels: example scenes and kernels for both levels of x86-64 are in them; an editable installation has neither."""

from __future__ import annotations

import fnmatch
import tomllib
from pathlib import Path
from typing import Any

import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import cache, fingerprint
from minirt.rendering import ahead_of_time
from tests.paths import ROOT

wheel_hook = pytest.importorskip("minirt.rendering.wheel_hook", reason="needs hatchling: make all")

with (ROOT / "pyproject.toml").open("rb") as _file:
    PROJECT = tomllib.load(_file)


SCENES = {"force_include": {str(ROOT / "scenes"): "minirt/scenes"}}


class App:
    """Records the warnings that a hook shows to the user."""

    def __init__(self) -> None:
        self.warnings: list[str] = []

    def display_warning(self, message: str) -> None:
        self.warnings.append(message)


def built(version: str = "standard") -> tuple[dict[str, Any], list[str]]:
    """Run the hook; return what it says of the wheel, and its warnings."""
    app, data = App(), dict[str, Any](pure_python=True, force_include={})
    hook = wheel_hook.ScenesAndKernels(str(ROOT), {}, None, None, str(ROOT), "wheel", app)
    hook.initialize(version, data)
    return data, app.warnings


@pytest.fixture
def folders(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Path, str]]:
    """Folders and processors for which kernels were compiled."""
    compiled: list[tuple[Path, str]] = []
    monkeypatch.setattr(ahead_of_time, "build", lambda folder, target: compiled.append((folder, target)))
    monkeypatch.setattr(fingerprint, "is_linux_on_x86_64", lambda: True)
    return compiled


def test_a_wheel_has_kernels_for_both_levels_which_the_project_file_includes(folders: list[tuple[Path, str]]) -> None:
    assert built() == ({"pure_python": False, "tag": wheel_hook.TAG, **SCENES}, [])
    assert folders == [(cache.SHIPPED / target, target) for target in (fingerprint.V3, fingerprint.V4)]
    (pattern,) = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["artifacts"]
    for folder, _ in folders:
        assert fnmatch.fnmatch((folder / "0.kernel").relative_to(ROOT).as_posix(), pattern)


def test_editable_installations_and_other_machines_get_no_kernels(
    folders: list[tuple[Path, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert built("editable") == ({"pure_python": True, "force_include": {}}, [])
    monkeypatch.setattr(fingerprint, "is_linux_on_x86_64", lambda: False)
    assert built() == ({"pure_python": True, **SCENES}, [])
    assert folders == []


def test_a_wheel_is_made_where_nothing_can_be_compiled(
    folders: list[tuple[Path, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_folder: Path, _target: str) -> None:
        raise RenderError("no compiler")

    monkeypatch.setattr(ahead_of_time, "build", fail)
    data, warnings = built()
    assert data == {"pure_python": True, **SCENES}
    assert warnings == ["the wheel has no kernels, programs will compile them: no compiler"]


def test_what_builds_a_wheel_is_what_runs_it() -> None:
    """The compiler of a wheel's kernels is of the versions that the program asks for."""
    build, run = PROJECT["build-system"]["requires"], PROJECT["project"]["dependencies"]
    assert set(build) - set(run) == {"hatchling"}
