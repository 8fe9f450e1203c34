"""Executors of the caller: workers that die, bands that fail, and the workers of dask, which makes bands again."""

from __future__ import annotations

import json
import logging
import os
import re
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import tifffile

import minirt
from minirt.cli import main, render
from minirt.cluster import executor
from minirt.cluster.job import Job, Made, render_sent_band, share_of_cores
from minirt.errors import RenderError
from minirt.rendering.settings import RenderSettings
from tests.cli.program import environment
from tests.cluster.scenes import BALL, with_files
from tests.paths import ROOT
from tests.processes import run, started
from tests.waiting import until

SIZE = 600, 400

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")


@pytest.mark.parametrize("make", [lambda: ProcessPoolExecutor(1), lambda: lambda: ProcessPoolExecutor(1)])
def test_a_worker_that_dies_ends_the_work_and_what_is_done_is_kept(make: Callable[[], Any], tmp_path: Path) -> None:
    """`dies` is run by an executor of the caller, and by one that a function makes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executor, "render_sent_band", dies)
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
    return render_sent_band(version, data, camera, band)


def fails(version: str, data: bytes, camera: minirt.Camera, band: Job) -> Made:
    """Fail as no band should."""
    raise KeyError(band.what)


def test_an_error_of_a_worker_is_told_with_its_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executor, "render_sent_band", fails)
    with ThreadPoolExecutor(1) as pool, pytest.raises(RenderError, match=r"(rows \d+ to \d+) failed: KeyError: '\1'"):
        minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, executor=pool)


def test_an_executor_that_is_shut_down_takes_no_tasks(tmp_path: Path) -> None:
    pool = ThreadPoolExecutor(1)
    pool.shutdown()
    with pytest.raises(RenderError, match="takes no tasks: cannot schedule new futures after shutdown"):
        minirt.render_to(tmp_path / "a.tif", BALL, *SIZE, executor=pool)


UNGUARDED = """
import minirt
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

make = lambda: ProcessPoolExecutor(1, get_context("spawn"))
minirt.render_to("a.tif", minirt.example(), 64, 48, executor=make if {is_made} else make())
"""


@pytest.mark.parametrize("is_made", [True, False])
def test_a_script_without_the_guard_is_told_to_have_it(tmp_path: Path, is_made: bool) -> None:
    (tmp_path / "script.py").write_text(UNGUARDED.format(is_made=is_made))
    ended = run([sys.executable, "script.py"], cwd=tmp_path, env=environment(), text=True)
    *_, last = ended.stderr.splitlines()
    assert ended.returncode == 1
    assert last.startswith("minirt.errors.RenderError: rows 0 to 47: its worker died: it ran this script once more: ")
    assert last.endswith("put the call below \"if __name__ == '__main__':\"")
    assert ended.stderr.count("Traceback") <= 2  # of this process, and none of the worker


def sends_half(version: str, data: bytes, camera: minirt.Camera, band: Job) -> Made:
    """Make the first band; of the result of another one send a half, and stop."""

    def send(self: Connection, result: Any) -> None:
        os.write(self.fileno(), struct.pack("!i", len(result)) + bytes(result)[: len(result) // 2])
        Path(os.environ["HALF"]).touch()
        signal.pause()

    if band.region.y:
        Connection._send_bytes = send  # type: ignore[method-assign]
    return render_sent_band(version, data, camera, band)


def test_a_pool_ends_though_half_a_result_has_come(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HALF", str(tmp_path / "half"))
    monkeypatch.setattr(executor, "render_sent_band", sends_half)
    bands = Job(BALL, SIZE, RenderSettings()).bands(8)
    made = executor.Dispatcher(lambda: ProcessPoolExecutor(1, get_context("spawn"))).results(
        bands, lambda _: None, in_order=True
    )
    before = set(threading.enumerate())
    next(made)
    until((tmp_path / "half").exists, "half a result")
    made.close()
    until(lambda: set(threading.enumerate()) <= before, "the end of the threads of the pool")


OF_DASK = pytest.mark.filterwarnings("ignore")  # those of another library


class Cluster(NamedTuple):
    """A scheduler and workers of dask with a thread each, all of them processes, and their client."""

    scheduler: subprocess.Popen[Any]
    workers: list[subprocess.Popen[Any]]
    client: Any


@contextmanager
def dask_cluster(folder: Path, count: int) -> Iterator[Cluster]:
    """Start a cluster of so many workers."""
    distributed = pytest.importorskip("distributed")
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    file = folder / "scheduler.json"

    def process(name: str, *arguments: str) -> subprocess.Popen[Any]:
        command = [sys.executable, "-m", f"distributed.cli.dask_{name}", *arguments, "--no-dashboard"]
        silent = dict.fromkeys(("stdout", "stderr"), subprocess.DEVNULL)
        return stack.enter_context(started(command, env=os.environ | {"PYTHONPATH": str(ROOT)}, **silent))

    with ExitStack() as stack:
        scheduler = process("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))
        until(lambda: file.exists() and file.read_text().endswith("}"), "the scheduler")
        place = "--scheduler-file", str(file), "--local-directory", str(folder)
        workers = [process("worker", *place, "--nthreads", "1", "--no-nanny") for _ in range(count)]
        client = distributed.Client(json.loads(file.read_text())["address"], set_as_default=False)
        stack.callback(client.close)
        client.wait_for_workers(count)
        client.run(exec, "import minirt; minirt.render(minirt.example(), 8, 6)")  # which loads the program
        yield Cluster(scheduler, workers, client)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A cluster of these tests."""
    with dask_cluster(tmp_path_factory.mktemp("dask"), 3) as made:
        yield made


@OF_DASK
@pytest.mark.parametrize("ending", ["scheduler", "workers"])
def test_the_end_of_a_cluster_is_told_with_what_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], ending: str
) -> None:
    monkeypatch.setattr(executor, "DESERTED", 0.0)
    BALL.save(tmp_path / "ball.rt")
    monkeypatch.chdir(tmp_path)
    arguments = "ball.rt", "--size", "300x1200", "-o", "a.tif"
    with dask_cluster(tmp_path, 1) as cluster:
        address = cluster.client.scheduler.address

        def end(share: render.Share, done: int, total: int) -> None:
            share.done, share.total = done, total
            if done == 2:
                for process in [cluster.scheduler] if ending == "scheduler" else cluster.workers:
                    process.kill()

        monkeypatch.setattr(render.Share, "note", end)
        assert main([*arguments, "--cluster", address]) == 1
    why = "has ended, or .*" if ending == "scheduler" else "has had no workers for 0 s"
    kept = r"\d of \d+ bands of the picture are kept in \.a\.tif\.journal; .*\n"
    assert re.fullmatch(rf"Error\nthe scheduler at {address} {why}\n{kept}", capsys.readouterr().err)
    assert main(arguments) == 0
    assert np.array_equal(tifffile.imread("a.tif"), minirt.render(BALL, 300, 1200).array)


@OF_DASK
@pytest.mark.parametrize(("harm", "when", "large"), [("STOP", 0, False), ("STOP", 0, True), ("KILL", 2, False)])
def test_bands_are_those_of_one_machine_though_a_worker_hangs_or_is_killed(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, harm: str, when: int, large: bool
) -> None:
    """After so many bands. A large scene is sent to one worker, which hands it to the others, and may hang."""
    for name, value in {"WATCH": 0.1, "LATE": 0.1, "LONGER": 2, "LARGE": 0 if large else 2**30}.items():
        monkeypatch.setattr(executor, name, value)
    scene, victim = with_files(tmp_path / "home"), cluster.workers[0]
    picture = minirt.render(scene, 300, 500, samples=4)

    def attack(done: int, _: int) -> None:
        if done == when:
            victim.send_signal(getattr(signal, f"SIG{harm}"))

    for workers in (cluster.client, cluster.client.get_executor()):
        minirt.render_to(tmp_path / "a.tif", scene, 300, 500, samples=4, executor=workers, on_progress=attack)
        assert np.array_equal(tifffile.imread(tmp_path / "a.tif"), picture.array)
        (tmp_path / "a.tif").unlink()
    victim.send_signal(signal.SIGCONT)


@OF_DASK
def test_a_worker_uses_its_share_of_the_processors(cluster: Cluster) -> None:
    assert cluster.client.submit(share_of_cores, pure=False).result() == 1
    assert share_of_cores() is None  # outside of workers: all of them


@OF_DASK
def test_the_program_sends_a_film_to_the_workers(
    cluster: Cluster, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    BALL.save(tmp_path / "ball.rt")
    monkeypatch.chdir(tmp_path)
    arguments = "ball.rt", "--turntable", "5", "--size", "60x30", "-o"
    assert main([*arguments, "a.gif", "--cluster", cluster.client.scheduler.address]) == 0
    assert main([*arguments, "b.gif"]) == 0
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
    assert capsys.readouterr() == ("", "")
    for name in ("asyncio", "distributed.client", "distributed.core", "tornado", "tornado.application"):
        assert not logging.getLogger(name).isEnabledFor(logging.CRITICAL)  # where a scheduler dies they have tracebacks
