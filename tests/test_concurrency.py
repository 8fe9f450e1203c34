"""Threads, asyncio and processes of users: pictures are the same everywhere, and Ctrl+C ends the work in each."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import minirt
from minirt.errors import ElementError, FieldError, Problem
from minirt.meshes.obj_lines import ObjError
from minirt.rendering import renderer
from tests.cli.program import SCENE, environment
from tests.processes import next_line, started
from tests.waiting import HANG_LIMIT

ENDLESS = """
import asyncio, multiprocessing, sys, threading
from concurrent.futures import ThreadPoolExecutor
import minirt
from tests.waiting import until

def announce():
    runner = minirt.renderer().runner
    until(lambda: runner.next_row.max() > 0 and minirt.renderer().busy.locked(), "the first row")
    print("begun", flush=True)

def work(_=None):
    threading.Thread(target=announce, daemon=True).start()
    minirt.render(minirt.load("ball.rt"), 4000, 2000, samples=65536)

async def wait():
    try:
        await asyncio.to_thread(work)
    except asyncio.CancelledError:
        minirt.renderer().cancel()
        raise

def main(way):
    if way == "main":
        work()
    elif way == "asyncio":
        asyncio.run(wait())
    elif way == "threads":
        with ThreadPoolExecutor(1) as pool:
            try:
                pool.submit(work).result()
            except KeyboardInterrupt:
                minirt.renderer().cancel()
                raise
    else:
        with multiprocessing.get_context(way).Pool(1) as pool:
            pool.apply(work)

if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except KeyboardInterrupt:
        sys.exit(130)
"""
PROCESSES = [each for each in ("fork", "spawn", "forkserver") if hasattr(os, "fork") or each == "spawn"]
QUIET = {"PYTHONWARNINGS": "ignore"}  # Python 3.12 warns of a fork beside threads


def write(folder: Path, source: str) -> None:
    """Write a program and its scene."""
    (folder / "ball.rt").write_text(SCENE)
    (folder / "program.py").write_text(source)


@pytest.mark.parametrize("way", ["main", "threads", "asyncio", *PROCESSES])
def test_ctrl_c_ends_the_work(tmp_path: Path, way: str) -> None:
    write(tmp_path, ENDLESS)
    command = [sys.executable, "program.py", way]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with started(command, cwd=tmp_path, env=environment() | QUIET, **streams) as process:
        assert next_line(process) == "begun"
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(timeout=HANG_LIMIT) == 130


ERRORS = [
    minirt.SceneError((Problem("a.rt", 3, 2, "sp 0", "must be a number", 2), Problem("a.rt", 0, 0, "", "is empty"))),
    minirt.FileError("wood.png", "is no picture"),
    minirt.RenderError("no size"),
    minirt.ReplayError("no keys"),
    minirt.MlxError("no display"),
    FieldError("must be > 0", 2),
    ElementError("two cameras"),
    ObjError("no such vertex", 7),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_errors_survive_pickling(error: Exception) -> None:
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)


def test_a_cancelled_picture_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = minirt.example()
    shared = minirt.renderer()
    monkeypatch.setattr(shared, "render", lambda *_, **__: False)
    monkeypatch.setattr(shared, "reach", lambda *_, **__: None)
    for samples in (1, "auto"):
        with pytest.raises(minirt.RenderError, match="cancelled"):
            minirt.render(scene, 4, 3, samples=samples)


def test_threads_that_ask_at_once_get_the_same_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "renderers", {})
    made: list[object] = []

    def make(*settings: object) -> object:
        made.append(settings)
        assert renderer.lock.lock.locked()  # no other thread makes one meanwhile
        return object()

    monkeypatch.setattr(renderer, "Renderer", make)
    with ThreadPoolExecutor(8) as pool:
        found = set(pool.map(lambda _: minirt.renderer(3), range(64)))
    assert len(found) == 1
    assert len(made) == 1
