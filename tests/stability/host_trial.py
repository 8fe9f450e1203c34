"""Tests in a process of their own that has loaded pytest beforehand, but nothing of the project."""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import hypothesis  # noqa: F401  (loaded once for all processes)
import numpy as np  # noqa: F401
import PIL.Image  # noqa: F401
import pytest

from tests.scheduling import file_of
from tests.stability.host_copy import LIMITS, ProjectCopy
from tests.stability.host_tests import Recorder

OPTIONS = ("-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:randomly", "--hypothesis-seed=0")
LOADED = ("-W", "ignore:Module already imported:pytest.PytestAssertRewriteWarning")  # hypothesis, which has no asserts
POLL = 0.02  # seconds between two looks at a process
LATE = -1000  # stands for the exit status of a process that took too long


class Order:
    """Plugin of pytest: runs the given tests alone, in the given order."""

    def __init__(self, names: Sequence[str]) -> None:
        self.order = {name: number for number, name in enumerate(names)}

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items[:] = sorted(
            (each for each in items if each.nodeid in self.order), key=lambda each: self.order[each.nodeid]
        )


def outcome(project: ProjectCopy, names: Sequence[str], seconds: float) -> str:
    """Run tests in a copy of the project: "survived", "killed", or "late" if they take longer than the seconds."""
    files = [*dict.fromkeys(file_of(name) for name in names)]
    status = ended(project, [*OPTIONS, *files], [Order(names)], project.fresh_cache(), seconds) if names else 0
    return {0: "survived", LATE: "late"}.get(status, "killed")


def record(project: ProjectCopy, paths: Sequence[str], marks: str, seconds: float, into: Path) -> None:
    """Run tests once, and write which lines each of them runs."""
    recorder = Recorder(project.root / "minirt")
    options = [each for each in OPTIONS if each != "-x"]
    ended(project, [*options, "-m", marks, *paths], [recorder], project.kernels, seconds, into)


def ended(
    project: ProjectCopy,
    arguments: list[str],
    plugins: list[object],
    cache: Path,
    seconds: float,
    into: Path | None = None,
) -> int:
    """Run pytest in a fork of this process, and return its exit status; `LATE` for one that takes too long."""
    process = os.fork()
    if process:
        return waited(process, seconds)
    status = 99
    try:
        enter(project, cache, seconds, quiet=into is None)
        status = int(pytest.main([*LOADED, *arguments], plugins))
        for each in plugins:
            if into is not None and isinstance(each, Recorder):
                each.write(into)
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(status)


def waited(process: int, seconds: float) -> int:
    """Wait for a process, and kill it with all of its group after the seconds."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        done, status = os.waitpid(process, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(POLL)
    with suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)
    os.waitpid(process, 0)
    return LATE


def enter(project: ProjectCopy, cache: Path, seconds: float, quiet: bool) -> None:
    """Make this process one of the copy: folder, environment, imports, limits."""
    os.setsid()
    os.chdir(project.root)
    os.environ.update(project.environment(cache))
    for name in ("SCENE", "DISPLAY", "WAYLAND_DISPLAY"):
        os.environ.pop(name, None)
    sys.path[:] = [str(project.root), *(each for each in sys.path if not (Path(each) / "minirt/__init__.py").exists())]
    for name in [each for each in sys.modules if each.split(".")[0] in ("minirt", "tests")]:
        del sys.modules[name]
    # Bytecode of a source would be taken for that of another of the same length and second.
    sys.dont_write_bytecode = True
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    if quiet:
        for name, limit in LIMITS.items():
            resource.setrlimit(getattr(resource, name), (limit, limit))
        nothing = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nothing, stream)
