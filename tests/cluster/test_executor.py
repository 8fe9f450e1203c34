"""Executors of the caller: workers that die, bands that fail, and the workers of dask, which makes bands again."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import minirt
from minirt.cli import main
from minirt.cluster import executor
from minirt.cluster.job import Job, Made
from minirt.cluster.worker import share_of_cores, work
from minirt.errors import RenderError
from tests.cluster.scenes import BALL, with_files

SIZE = 600, 400

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")


@pytest.mark.parametrize("make", [lambda: ProcessPoolExecutor(1), lambda: lambda: ProcessPoolExecutor(1)])
def test_a_worker_that_dies_ends_the_work_and_what_is_done_is_kept(make: Callable[[], Any], tmp_path: Path) -> None:
    """`dies` is run by an executor of the caller, and by one that a function makes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executor, "work", dies)
        with pytest.raises(RenderError, match=r"rows \d+ to \d+: its worker died"):
            minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, executor=make())
    assert not (tmp_path / "a.tif").exists()
    done: list[int] = []
    minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, on_progress=lambda number, _: done.append(number))
    assert done[0] > 0
    assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), minirt.render(BALL, *SIZE).array)


def dies(version: str, data: bytes, camera: minirt.Camera, band: Job) -> Made:
    """Die of one band."""
    if band.region.y > 300:
        os.kill(os.getpid(), signal.SIGKILL)
    return work(version, data, camera, band)


def fails(version: str, data: bytes, camera: minirt.Camera, band: Job) -> Made:
    """Fail as no band should."""
    raise KeyError(band.what)


def test_an_error_of_a_worker_is_told_with_its_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executor, "work", fails)
    with ThreadPoolExecutor(1) as pool, pytest.raises(RenderError, match=r"(rows \d+ to \d+) failed: KeyError: '\1'"):
        minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, executor=pool)


def test_an_executor_that_is_shut_down_takes_no_tasks(tmp_path: Path) -> None:
    pool = ThreadPoolExecutor(1)
    pool.shutdown()
    with pytest.raises(RenderError, match="takes no tasks: cannot schedule new futures after shutdown"):
        minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, executor=pool)


OF_DASK = pytest.mark.filterwarnings("ignore")  # those of another library


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """A dask cluster of two workers with a thread each, which are processes of their own."""
    distributed = pytest.importorskip("distributed")
    how = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(**how) as cluster, distributed.Client(cluster, set_as_default=False) as client:
        yield client


@OF_DASK
def test_bands_are_those_of_one_machine_though_a_worker_is_killed(client: Any, tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")

    def kill(done: int, _: int) -> None:
        if done == 2:
            os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)

    for workers in (client, client.get_executor()):
        minirt.render_to(tmp_path / "a.tif", scene, 300, 500, samples=4, executor=workers, on_progress=kill)
        picture = minirt.render(scene, 300, 500, samples=4)
        assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture.array)
        (tmp_path / "a.tif").unlink()


@OF_DASK
def test_a_worker_uses_its_share_of_the_processors(client: Any) -> None:
    assert client.submit(share_of_cores, pure=False).result() == 1
    assert share_of_cores() is None  # outside of workers: all of them


@OF_DASK
def test_the_program_sends_a_film_to_the_workers(
    client: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    BALL.save(tmp_path / "ball.rt")
    monkeypatch.chdir(tmp_path)
    arguments = "ball.rt", "--turntable", "5", "--size", "60x30", "-o"
    assert main([*arguments, "a.gif", "--cluster", client.scheduler.address]) == 0
    assert main([*arguments, "b.gif"]) == 0
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
    assert capsys.readouterr() == ("", "")
