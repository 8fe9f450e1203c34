"""Scenes travel by content, with their pictures and meshes."""

from __future__ import annotations

import shutil
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt import Scene
from minirt.cluster import files, parcel, worker
from minirt.cluster.parcel import pack, unpack
from minirt.cluster.task import Made, Missing, Settings, Task, version
from minirt.errors import FileError, RenderError
from tests.cluster.scenes import BALL, with_files


@pytest.fixture
def machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Another machine: no files of scenes, and none in memory."""
    path = tmp_path / "files"

    def folder() -> Path:
        path.mkdir(exist_ok=True)
        return path

    monkeypatch.setattr(files, "folder", folder)
    monkeypatch.setattr(files, "checked", set())
    monkeypatch.setattr(worker, "scenes", {})
    parcel.loaded_mesh.cache_clear()
    parcel.kept_mesh.cache_clear()
    return path


def task_for(packed: parcel.Parcel) -> Task:
    return Task(version(), packed.digest, packed.files, Settings(40, 30), "light")


def test_a_worker_asks_for_what_it_lacks_and_draws_the_same_picture(tmp_path: Path, machine: Path) -> None:
    scene = with_files(tmp_path / "home")
    expected = minirt.render(scene, 40, 30)
    packed = pack(scene)
    assert len(packed.files) == 2  # a picture that is there twice, and the mesh
    contents = {each: files.read(each) for each in packed.files}
    shutil.rmtree(tmp_path / "home")
    shutil.rmtree(machine)
    files.checked.clear()
    parcel.loaded_mesh.cache_clear()
    answer = worker.carry_out(task_for(packed))
    assert isinstance(answer, Missing)
    assert set(answer.digests) == {packed.digest, *packed.files}
    made = worker.carry_out(task_for(packed)._replace(sent={**contents, packed.digest: packed.data}))
    assert isinstance(made, Made)
    assert np.array_equal(made.arrays[1], expected.linear)
    again = worker.carry_out(task_for(packed))  # without anything sent
    assert isinstance(again, Made)


def elsewhere(folder: Path) -> None:
    """Let this process be on another machine, with files of its own."""
    files.folder = lambda: folder  # type: ignore[assignment]
    files.checked.clear()
    worker.scenes.clear()
    parcel.loaded_mesh.cache_clear()


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
def test_contents_are_sent_to_processes_that_lack_them(tmp_path: Path, machine: Path) -> None:
    scene = with_files(tmp_path / "home")
    other = tmp_path / "other"
    other.mkdir()
    with ProcessPoolExecutor(2, get_context("fork"), elsewhere, (other,)) as pool:
        (image,) = minirt.render_all([scene], 40, 30, executor=pool)
    assert np.array_equal(image.array, minirt.render(scene, 40, 30).array)
    assert sorted(each.name for each in other.iterdir()) == sorted(pack(scene).files)


def test_a_file_that_cannot_be_kept_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "folder", lambda: tmp_path / "absent")
    with pytest.raises(RenderError, match=r"the files of the scene cannot be kept in .*absent"):
        list(minirt.render_all([with_files(tmp_path / "home")], 40, 30))


def test_a_damaged_file_counts_as_missing(tmp_path: Path, machine: Path) -> None:
    packed = pack(with_files(tmp_path / "home"))
    file = machine / packed.files[0]
    file.write_bytes(file.read_bytes()[:-1] + b"?")
    files.checked.clear()
    answer = worker.carry_out(task_for(packed)._replace(sent={packed.digest: packed.data}))
    assert answer == Missing((packed.files[0],))


def test_the_digest_is_that_of_all_values_and_contents(tmp_path: Path, machine: Path) -> None:
    first, second = with_files(tmp_path / "a"), with_files(tmp_path / "b")
    assert pack(first).digest == pack(second).digest
    edited = second.replace(second.spheres[0], diameter=np.nextafter(second.spheres[0].diameter, 9))
    assert pack(edited).digest != pack(first).digest
    minirt.render(BALL, 20, 11).save(tmp_path / "b" / "beside.png")
    assert pack(second).digest != pack(first).digest


def test_a_scene_made_of_the_same_objects_or_of_equal_ones_has_one_digest(machine: Path) -> None:
    colour = (10.0, 20.0, 30.0)
    shared = Scene([BALL.camera, *(minirt.Sphere((x, 0, 0), 1, colour) for x in (1, 2))])
    equal = Scene([BALL.camera, *(minirt.Sphere((x, 0, 0), 1, tuple(map(float, colour))) for x in (1, 2))])
    assert pack(shared).digest == pack(equal).digest


def test_no_value_is_changed_on_the_way(machine: Path) -> None:
    """Not by a bit: a direction that is normalised twice may differ."""
    random = np.random.Generator(np.random.PCG64(3))
    planes = [minirt.Plane((0, 0, 0), each / np.linalg.norm(each), (1, 2, 3)) for each in random.normal(size=(99, 3))]
    scene = Scene([BALL.camera, *planes])
    again = unpack(pack(scene).data)
    assert [vars(each) for each in again.elements] == [vars(each) for each in scene.elements]


def test_meshes_stay_one_object(tmp_path: Path, machine: Path) -> None:
    packed = pack(with_files(tmp_path / "a"))
    first, second = unpack(packed.data), unpack(packed.data)
    assert first.meshes[0].file.triangles is second.meshes[0].file.triangles


def test_a_file_that_has_gone_is_an_error(tmp_path: Path, machine: Path) -> None:
    scene = with_files(tmp_path / "a")
    (tmp_path / "a" / "beside.png").unlink()
    with pytest.raises(FileError, match=r"beside\.png"):
        pack(scene)


def test_another_version_refuses_to_draw() -> None:
    task = task_for(pack(BALL))
    with pytest.raises(RenderError, match="another miniRT"):
        worker.carry_out(task._replace(version="0.0.9 0123"))
