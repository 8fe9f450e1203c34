"""Scenes travel with their pictures and meshes, and no value of them is changed."""

from __future__ import annotations

import shutil
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt import Scene
from minirt.cluster import worker
from minirt.cluster.job import Job
from minirt.cluster.worker import packed, unpacked, work
from minirt.errors import FileError, RenderError
from minirt.rendering.settings import RenderSettings
from tests.cluster.scenes import BALL, with_files


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers keep no scenes, and their files in a folder of this test."""
    (tmp_path / "files").mkdir()
    unpacked.cache_clear()
    monkeypatch.setattr(worker, "folder", lambda: tmp_path / "files")


def test_a_machine_without_the_files_draws_the_same_picture(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")
    expected = minirt.render(scene, 40, 30)
    data = packed(scene, with_files=True)
    shutil.rmtree(tmp_path / "home")
    for _ in range(2):
        made = work(worker.version(), data, scene.camera, Job(BALL, (40, 30), RenderSettings()))
        assert np.array_equal(made.linear, expected.linear)
        assert len(list((tmp_path / "files").iterdir())) == 1  # a picture that is there twice
    assert unpacked.cache_info().misses == 1


def test_executors_that_may_be_elsewhere_get_the_files(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")
    for pool, count in ((ProcessPoolExecutor(1), 0), (ThreadPoolExecutor(1), 1)):
        with pool:
            (image,) = minirt.render_all([scene], 40, 30, executor=pool)
        assert np.array_equal(image.array, minirt.render(scene, 40, 30).array)
        assert len(list((tmp_path / "files").iterdir())) == count


def test_no_value_is_changed_on_the_way() -> None:
    """Not by a bit: a direction that is normalised twice may differ."""
    random = np.random.Generator(np.random.PCG64(3))
    planes = [minirt.Plane((0, 0, 0), each / np.linalg.norm(each), (1, 2, 3)) for each in random.normal(size=(99, 3))]
    scene = Scene([BALL.camera, *planes])
    again = unpacked(packed(scene, with_files=False))
    assert [vars(each) for each in again.elements] == [vars(each) for each in scene.elements]


def test_meshes_travel_without_what_was_computed_of_them(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "a")
    mesh = scene.meshes[0].file.triangles
    small = len(packed(scene, with_files=False))
    mesh.__dict__["computed"] = bytes(10**6)
    assert len(packed(scene, with_files=False)) == small
    again = unpacked(packed(scene, with_files=False)).meshes[0].file.triangles
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.corners, mesh.corners)


def test_a_file_that_has_gone_is_an_error(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "a")
    (tmp_path / "a" / "beside.png").unlink()
    with pytest.raises(FileError, match=r"beside\.png"):
        packed(scene, with_files=True)


def test_another_version_refuses_to_draw() -> None:
    with pytest.raises(RenderError, match="another miniRT"):
        work("0.0.9 0123", b"", BALL.camera, Job(BALL, (40, 30), RenderSettings()))
