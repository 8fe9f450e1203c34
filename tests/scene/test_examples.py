"""Example scenes of the library: all can be read, rendered and saved anywhere."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.scene import examples
from tests.paths import SCENES


def test_the_examples_are_the_scenes() -> None:
    assert minirt.examples() == sorted(path.stem for path in SCENES.glob("*.rt"))


@pytest.mark.parametrize("name", minirt.examples())
def test_an_example_has_the_elements_of_its_file(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene, read = minirt.example(name), minirt.load(SCENES / f"{name}.rt")
    assert len(scene.elements) == len(read.elements)
    assert [type(each) for each in scene.elements] == [type(each) for each in read.elements]
    assert [each.colour for each in scene.shapes] == [each.colour for each in read.shapes]


@pytest.mark.parametrize("name", ["gallery-marbles", "meshes"])
def test_a_saved_example_looks_the_same_elsewhere(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    minirt.example(name).save("copy.rt")
    shown = minirt.render(minirt.load("copy.rt"), 64, 36).array
    assert np.array_equal(shown, minirt.render(minirt.load(SCENES / f"{name}.rt"), 64, 36).array)


def test_a_folder_that_no_line_can_name_keeps_the_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "with blanks"
    folder.symlink_to(SCENES)
    monkeypatch.setattr(examples, "FOLDERS", (folder,))
    scene = minirt.example("sky")
    assert scene.file == folder / "sky.rt"
    assert np.array_equal(minirt.render(scene, 8, 6).array, minirt.render(minirt.load(SCENES / "sky.rt"), 8, 6).array)


def test_an_unknown_name_and_missing_scenes_are_errors(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(minirt.FileError, match="did you mean gallery-chess"):
        minirt.example("galery-chess")
    monkeypatch.setattr(examples, "FOLDERS", (tmp_path,))
    with pytest.raises(minirt.FileError, match="not installed"):
        minirt.example()
