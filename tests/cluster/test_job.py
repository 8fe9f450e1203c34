"""Jobs and workers: rows, bands, the error of the whole by those of the bands, and scenes that travel unchanged."""

from __future__ import annotations

import shutil
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from math import isclose
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import minirt
from minirt import Scene
from minirt.cluster import job
from minirt.cluster.job import (
    LEAST_PIXELS,
    MOST_BANDS,
    MOST_PIXELS,
    ROWS,
    Job,
    packed,
    render_sent_band,
    rows_of,
    unpacked,
    whole,
)
from minirt.errors import FileError, RenderError
from minirt.kernel.frame import TILE
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Region
from minirt.rendering.settings import RenderSettings
from tests.cluster.scenes import BALL, with_files

SIZE = 70, 61


@pytest.mark.parametrize("rows", [(-1, 5), (3, 3), (5, 62)])
def test_rows_that_are_not_there_are_refused(rows: tuple[int, int]) -> None:
    with pytest.raises(RenderError, match="region"):
        minirt.render(BALL, *SIZE, rows=rows)
    with pytest.raises(RenderError, match="a region or rows, not both"):
        minirt.render(BALL, *SIZE, rows=(0, 5), region=(0, 0, 5, 5))


@given(st.integers(1, 300_000), st.integers(1, 300_000), st.sampled_from([1, 64, 65536]))
def test_bands_are_all_rows_once_by_whole_tiles_and_of_bounded_size(width: int, height: int, samples: int) -> None:
    bands = rows_of(Region(0, 0, width, height), samples)
    ends = [band.y + band.height for band in bands]
    assert [0, *ends] == [*(band.y for band in bands), height]
    assert all(band[::2] == (0, width) and band.y % TILE == 0 and band.height > 0 for band in bands)
    limit = max(TILE, min(MOST_PIXELS // width, max(ROWS, LEAST_PIXELS // width)))
    assert max(band.height for band in bands) <= 1.5 * limit + TILE
    assert len(bands) <= max(MOST_BANDS, len(rows_of(Region(0, 0, width, height), 1)))


def test_bands_of_a_region_lie_in_it_and_many_samples_make_more_of_them() -> None:
    assert rows_of(Region(5, 7, 600, 100), 1) == [(5, 7, 600, 48), (5, 55, 600, 52)]
    assert [each.height for each in rows_of(Region(5, 7, 600, 100), 2**20)] == [16, 16, 16, 16, 16, 16, 4]


def rows(count: int) -> Region:
    return Region(0, 0, 40, count)


def outcome(error: float, samples: float = 2.0, goal: float = 0.01) -> Outcome:
    return Outcome(samples, int(4 * samples), error, 1.0, goal)


def test_the_error_of_the_whole_is_that_of_all_pixels_together() -> None:
    """Noise of a known size in each band, against the root of the mean square over the whole picture."""
    random = np.random.Generator(np.random.PCG64(1))
    noises = [random.normal(0, error, (count, 40)) for count, error in ((64, 0.02), (64, 0.001), (17, 0.1))]
    errors = [float(np.sqrt((noise**2).mean())) for noise in noises]
    together = whole([(rows(len(noise)), outcome(error)) for noise, error in zip(noises, errors, strict=True)])
    assert together
    assert isclose(together.error, np.sqrt((np.concatenate(noises) ** 2).mean()), rel_tol=1e-12)
    assert not isclose(together.error, sum(errors) / 3, rel_tol=0.05)  # a planted wrong mean


@given(st.lists(st.tuples(st.integers(1, 64), st.floats(0, 0.01)), min_size=1, max_size=9))
def test_where_each_band_reaches_the_goal_the_whole_does(bands: list[tuple[int, float]]) -> None:
    together = whole([(rows(count), outcome(error)) for count, error in bands])
    assert together
    assert together.error <= 0.01 * (1 + 1e-12)


def test_samples_of_the_whole_are_a_mean_over_rows_and_a_band_without_outcome_leaves_none() -> None:
    together = whole([(rows(30), outcome(0.01, 2.0)), (rows(10), outcome(0.01, 6.0))])
    assert together
    assert (together.samples, together.most, together.seconds) == (3.0, 24, 2.0)
    assert whole([(rows(30), outcome(0.01)), (rows(10), None)]) is None


# Scenes travel with their pictures and meshes, and no value of them is changed.


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers keep no scenes, and their files in a folder of this test."""
    (tmp_path / "files").mkdir()
    unpacked.cache_clear()
    monkeypatch.setattr(job, "folder", lambda: tmp_path / "files")


def test_a_machine_without_the_files_draws_the_same_picture(tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")
    expected = minirt.render(scene, 40, 30, linear=True)
    data = packed(scene, with_files=True)
    shutil.rmtree(tmp_path / "home")
    for _ in range(2):
        made = render_sent_band(job.version(), data, scene.camera, Job(BALL, (40, 30), RenderSettings()))
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
        render_sent_band("0.0.9 0123", b"", BALL.camera, Job(BALL, (40, 30), RenderSettings()))
