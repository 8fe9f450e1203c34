"""Wheels: example scenes and kernels that were compiled before are in them; an editable installation has neither."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tomllib
from email.parser import Parser
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest

from tests.paths import PACKAGE, ROOT
from tests.processes import run

builders = pytest.importorskip("hatchling.builders.wheel", reason="needs hatchling: make all")

PURE = "minirt-0.1.0-py3-none-any.whl"
KERNELS = [f"minirt/kernel/ahead_of_time/{level}/0.kernel" for level in ("x86-64-v3", "x86-64-v4")]
OWN_KERNEL = "minirt/kernel/ahead_of_time/native/0.kernel"  # of a processor without a level
# Prints everything that the package reads beside its modules.
READ_ALL = """
import json
from minirt.cli.arguments import argument_parser
from minirt.cli.options import completion
from minirt.formats import xpm
from minirt.helpers import package
from minirt.rendering.tone_mapping import blue_noise
from minirt.report import page
from minirt.viewer.app.desktop import application_icons
from minirt.viewer.language import catalogue

try:
    from minirt.notebook.widget import Viewer as viewer
except ImportError:
    viewer = None
print(json.dumps([
    argument_parser().format_help(), completion(argument_parser(), "bash"), xpm.names(), blue_noise().tolist(),
    [package.read(page.__name__, f"page.{kind}").decode() for kind in ("txt", "html", "css", "js")],
    [icon.pixels.tolist() for icon in application_icons()], catalogue("fr")[0], catalogue("xx")[0],
    str(getattr(viewer, "_esm", None)),
]))
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A copy of what a wheel is made of, without kernels."""
    folder = tmp_path / "project"
    ignored = shutil.ignore_patterns("__pycache__", "ahead_of_time")
    for name in ("minirt", "scenes"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignored)
    for name in ("pyproject.toml", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, folder)
    return folder


def build(project: Path, version: str = "standard") -> Path:
    """Return the wheel of a project."""
    builder = builders.WheelBuilder(str(project))
    return Path(next(builder.build(directory=str(project / "dist"), versions=[version])))


def names(wheel: Path) -> set[str]:
    """Return the names of the files in a wheel."""
    with ZipFile(wheel) as file:
        return set(file.namelist())


def test_a_wheel_has_the_scenes_and_names_its_makers_and_its_system(project: Path) -> None:
    wheel = build(project)
    assert wheel.name == PURE
    assert {f"minirt/scenes/{scene.name}" for scene in (ROOT / "scenes").glob("*.rt")} < names(wheel)
    with ZipFile(wheel) as file:
        metadata = Parser().parsestr(file.read("minirt-0.1.0.dist-info/METADATA").decode())
    assert metadata["Author"] == "the miniRT developers"
    systems = [each for each in metadata.get_all("Classifier", []) if each.startswith("Operating System")]
    assert systems == ["Operating System :: POSIX :: Linux"]


def test_a_wheel_has_the_kernels_that_fit_other_machines_too(project: Path) -> None:
    for name in (*KERNELS, OWN_KERNEL):
        (project / name).parent.mkdir(parents=True)
        (project / name).write_bytes(b"")
    wheel = build(project)
    assert wheel.name == "minirt-0.1.0-py3-none-manylinux_2_17_x86_64.whl"
    assert {name for name in names(wheel) if name.endswith(".kernel")} == set(KERNELS)
    editable = build(project, "editable")
    assert editable.name == PURE
    assert not [name for name in names(editable) if name.startswith("minirt/")]


def test_an_installation_compiles_nothing(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """pip builds a wheel to learn the name of a project, in silence: only hatchling is there, and no compiler."""
    with (project / "pyproject.toml").open("rb") as file:
        assert tomllib.load(file)["build-system"]["requires"] == ["hatchling"]
    for name in ("numpy", "numba", "llvmlite"):
        monkeypatch.setitem(sys.modules, name, None)  # its import fails
    for name in [each for each in sys.modules if each.partition(".")[0] == "minirt"]:
        monkeypatch.delitem(sys.modules, name)
    assert not [name for name in names(build(project)) if name.endswith(".kernel")]
    assert not list(project.rglob("*.kernel"))


def read_all(*path: Path) -> Any:
    """Return what `READ_ALL` prints, with packages from a path."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, path))}
    done = run([sys.executable, "-P", "-W", "error", "-c", READ_ALL], env=environment, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


def test_a_wheel_on_the_path_has_all_files_that_lie_beside_modules(project: Path) -> None:
    assert read_all(build(project)) == read_all(ROOT)
    own_path = re.compile(r"(?<![.\w])__file__")
    reading = {file for file in PACKAGE.rglob("*.py") if own_path.search(file.read_text(encoding="utf-8"))}
    in_folders = {"kernel/machine_code/fingerprint.py", "scene/examples.py"}  # kernels and scenes are in folders alone
    assert {file.relative_to(PACKAGE).as_posix() for file in reading} == in_folders
