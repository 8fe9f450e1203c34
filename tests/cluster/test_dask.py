"""Bands and frames on the workers of a dask cluster, which are processes of their own."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import minirt
from minirt.cli import main
from minirt.cluster.worker import share_of_cores
from tests.cluster.scenes import BALL, with_files

distributed = pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL"),
    pytest.mark.filterwarnings("ignore"),  # those of another library
]


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Two workers with a thread each."""
    how = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(**how) as cluster, distributed.Client(cluster, set_as_default=False) as client:
        yield client


def test_bands_are_those_of_one_machine_though_a_worker_is_killed(client: Any, tmp_path: Path) -> None:
    scene = with_files(tmp_path / "home")

    def kill(done: int, _: int) -> None:
        if done == 2:
            os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)

    for executor in (client, client.get_executor()):
        minirt.render_to(tmp_path / "a.tif", scene, 300, 500, samples=4, executor=executor, on_progress=kill)
        picture = minirt.render(scene, 300, 500, samples=4)
        assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture.array)
        (tmp_path / "a.tif").unlink()


def test_a_worker_uses_its_share_of_the_processors(client: Any) -> None:
    assert client.submit(share_of_cores, pure=False).result() == 1
    assert share_of_cores() is None  # outside of workers: all of them


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
