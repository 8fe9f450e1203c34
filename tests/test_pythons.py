"""`make pythons` finds the Pythons of a machine, and the README names those that are tested."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from tests import pythons
from tests.pages import read

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="programs are no scripts there")


def python(path: Path, program: str) -> Path:
    """Make a program in a new folder."""
    path.parent.mkdir(parents=True)
    path.write_text(f"#!/bin/sh\n{program}\n")
    path.chmod(0o755)
    return path


def test_the_readme_names_the_pythons_that_are_tested() -> None:
    *first, last = pythons.named()
    assert f"with Python {', '.join(first)} and {last} on" in read("README.md")


def test_newer_pythons_are_looked_for() -> None:
    assert pythons.newer(["3.11", "3.12"]) == ["3.13", "3.14", "3.15"]


def test_a_python_on_the_path_comes_before_those_of_pyenv_unless_it_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = python(tmp_path / "bin" / "python3.99", "exit 0")
    in_pyenv = python(tmp_path / "pyenv" / "versions" / "3.99.1" / "bin" / "python", "exit 0")
    monkeypatch.setenv("PATH", f"{found.parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "pyenv"))
    assert pythons.find("3.99") == found
    found.write_text("#!/bin/sh\nexit 127\n")  # as a shim of pyenv for a version that is not chosen
    assert pythons.find("3.99") == in_pyenv
    in_pyenv.write_text("#!/bin/sh\nexit 1\n")  # without venv
    assert pythons.find("3.99") is None


def test_each_python_is_told_of(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    outcomes = {"3.1": True, "3.2": False, "3.5": True}
    monkeypatch.setattr(pythons, "named", lambda: ["3.1", "3.2", "3.3"])
    monkeypatch.setattr(pythons, "find", lambda version: Path("python") if version != "3.3" else None)
    monkeypatch.setattr(pythons, "has_numba", lambda version: version == "3.5")
    monkeypatch.setattr(pythons, "passes", lambda version, _: outcomes[version])
    assert pythons.main() == 1
    assert capsys.readouterr().out.splitlines()[-6:] == [
        "Python 3.1: passed",
        "Python 3.2: FAILED",
        "Python 3.3: not found on PATH or in pyenv",
        "Python 3.4: numba has no wheels for it",
        "Python 3.5: passed",
        "Python 3.6: numba has no wheels for it",
    ]
    outcomes["3.2"] = True
    assert pythons.main() == 0
    monkeypatch.setattr(pythons, "find", lambda _: None)
    assert pythons.main() == 1
